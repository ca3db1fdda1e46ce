#pragma once

// Transfer that goes with a skin: one to three zonal lobes a vertex, four bytes each, whose axes turn as its
// normal does (docs/math.md, section 21; Sloan, Luna and Snyder, "Local, deformable precomputed radiance
// transfer", 2005). Fitted by prt/lobe_fit.h, written to files by prt/lobe_gltf.h, and evaluated here and by
// shaders/prt_lobes.glsl. Experimental.
//
//     const glm::mat3 turn = axis_turn(skin_matrix);               // of the vertex, in this frame
//     std::array<Lobe, kMostLobes> lobes;
//     model.decode(vertex, lobes);
//     for (Lobe& lobe : lobes)
//         lobe.axis = turned_axis(lobe.axis, turn);
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

inline constexpr std::size_t kMostLobes = 3, kMostProfiles = 256;
/// Bands of a lobe: a vector of four in shaders, and as many as a volume has of incident light.
inline constexpr int kMostLobeOrder = 4;
/// Largest magnitude of a number of a profile that files hold: what bounces add up to is a few.
inline constexpr float kLargestGain = 1e3f;

/// What a lobe makes of light of each band, 0 beyond the order. The cosine lobe of an open receiver has 1,
/// 2/3, 1/4, 0.
using LobeProfile = std::array<float, kMostLobeOrder>;

/// A part of a transfer vector that is symmetric about an axis: T_lm = profile_l Y_lm(axis).
struct Lobe {
    glm::vec3 axis{0, 0, 1}; ///< unit
    LobeProfile profile{};
};

/// A lobe as a vertex has it: its axis in two bytes (`coded_axis`), the number of a profile, and a factor in
/// steps of 1/255.
using LobeWord = std::array<std::uint8_t, 4>;

/// Octahedral (Cigolle et al. 2014, "A survey of efficient representations for independent unit vectors"),
/// 127 for 0 and 254 for 1, so that the six axes are exact. 0.95 degrees off at most.
std::array<std::uint8_t, 2> coded_axis(const glm::vec3& unit);
glm::vec3 decoded_axis(std::uint8_t x, std::uint8_t y);

/// The lobes of all vertices of a file.
struct LobeModel {
    int order = 0;         ///< 2..kMostLobeOrder
    std::size_t lobes = 0; ///< of a vertex, 1..kMostLobes
    std::vector<LobeProfile> profiles;
    std::vector<LobeWord> words; ///< [vertices][lobes], axes in the frame of the vertices' normals

    std::size_t vertices() const { return lobes == 0 ? 0 : words.size() / lobes; }
    Lobe decode(const LobeWord& word) const;
    /// Writes the lobes of a vertex to `to`, [lobes or more]; those beyond are dark.
    void decode(std::size_t vertex, std::span<Lobe> to) const;
};

/// Throws `Error` unless order, number of lobes and profiles are such as the comments above say, and all
/// words have a profile.
void check_lobes(const LobeModel& model);

/// How the axes of a vertex turn with the matrix that it goes by, blended by its skin's weights and not
/// necessarily a rotation: as normals do, by the cofactors, so that an open vertex is lit by its normal in
/// every pose.
glm::mat3 axis_turn(const glm::mat3& matrix);
/// Unit; as it was where the matrix leaves nothing of it.
glm::vec3 turned_axis(const glm::vec3& axis, const glm::mat3& turn);

/// Exit radiance for albedo 1, not below 0. `light`: coefficients of incident light, [light_order²]; bands of
/// lobes beyond it are left out.
glm::vec3 lobe_radiance(std::span<const Lobe> lobes, std::span<const glm::vec3> light, int light_order);

/// The transfer vector [order²] that lobes are together, order at most kMostLobeOrder.
void lobe_transfer(std::span<const Lobe> lobes, int order, std::span<float> transfer);

} // namespace prt
