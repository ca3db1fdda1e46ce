#pragma once

// Transfer for skinned meshes: one to three zonal lobes per vertex, four bytes each, whose axes rotate like
// the vertex normal (docs/math.md, section 21; Sloan, Luna and Snyder, "Local, deformable precomputed
// radiance transfer", 2005). Fitted by prt/lobe_fit.h, written to files by prt/lobe_gltf.h, and evaluated
// here and by shaders/prt_lobes.glsl. Experimental.
//
//     const glm::mat3 rotation = axis_rotation(skin_matrix); // blended skin matrix of the vertex
//     std::array<Lobe, kMaxLobes> lobes;
//     model.decode(vertex, lobes);
//     for (Lobe& lobe : lobes)
//         lobe.axis = rotated_axis(lobe.axis, rotation);
//     const glm::vec3 radiance = albedo * lobe_radiance(lobes, light, model.order);

#include "prt/support/glm_layout.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Maximum number of lobes per vertex, and of profiles per model.
inline constexpr std::size_t kMaxLobes = 3, kMaxProfiles = 256;
/// Maximum number of bands of a lobe: a vec4 in shaders, and the maximum order of incident light of a volume.
inline constexpr int kMaxLobeOrder = 4;
/// Maximum magnitude of a profile coefficient in files. Valid values are far smaller, even with all bounces.
inline constexpr float kMaxGain = 1e3f;

/// Response of a lobe to the light of each band, 0 beyond the order. The cosine lobe of an unoccluded
/// receiver has 1, 2/3, 1/4, 0.
using LobeProfile = std::array<float, kMaxLobeOrder>;

/// Component of a transfer vector with rotational symmetry about an axis: T_lm = profile_l Y_lm(axis).
struct Lobe {
    glm::vec3 axis{0, 0, 1}; ///< unit
    LobeProfile profile{};
};

/// A lobe as stored per vertex: its axis in two bytes (`coded_axis`), the index of a profile, and a factor in
/// steps of 1/255.
using LobeWord = std::array<std::uint8_t, 4>;

/// Codes a unit vector in octahedral form (Cigolle et al. 2014, "A survey of efficient representations for
/// independent unit vectors"). Byte 127 is 0 and 254 is 1, so that the six axes are exact. The maximum error
/// is 0.95 degrees.
std::array<std::uint8_t, 2> coded_axis(const glm::vec3& unit);
/// Returns the unit vector of `coded_axis`.
glm::vec3 decoded_axis(std::uint8_t x, std::uint8_t y);

/// The lobes of all vertices of a file.
struct LobeModel {
    int order = 0;         ///< 2..kMaxLobeOrder
    std::size_t lobes = 0; ///< per vertex, 1..kMaxLobes
    std::vector<LobeProfile> profiles;
    std::vector<LobeWord> words; ///< [vertices][lobes], axes in the frame of the vertex normals

    std::size_t vertices() const { return lobes == 0 ? 0 : words.size() / lobes; }
    /// Returns the lobe of a stored word.
    Lobe decode(const LobeWord& word) const;
    /// Writes the lobes of a vertex to `to`, [lobes or more]; additional entries have zero profiles.
    void decode(std::size_t vertex, std::span<Lobe> to) const;
};

/// Throws `Error` unless order, number of lobes and profiles are in the documented ranges, and the profile of
/// every word exists.
void check_lobes(const LobeModel& model);

/// Returns the matrix that transforms the lobe axes of a vertex. `matrix` is the blended skin matrix of the
/// vertex, not necessarily a rotation. Axes transform like normals, by the cofactors, so that an unoccluded
/// vertex is lit by its normal in every pose.
glm::mat3 axis_rotation(const glm::mat3& matrix);
/// Returns the transformed axis, normalised; `axis` itself if its transformed length is 0 or not finite.
glm::vec3 rotated_axis(const glm::vec3& axis, const glm::mat3& rotation);

/// Computes the exit radiance for albedo 1, clamped to 0. `light`: coefficients of incident light,
/// [light_order²]; bands of lobes above `light_order` are ignored.
glm::vec3 lobe_radiance(std::span<const Lobe> lobes, std::span<const glm::vec3> light, int light_order);

/// Computes the sum of the lobes as a transfer vector [order²]; order is at most kMaxLobeOrder.
void lobe_transfer(std::span<const Lobe> lobes, int order, std::span<float> transfer);

} // namespace prt
