#pragma once

// Transfer for skinned meshes: one to three zonal lobes per vertex, four bytes each, whose axes rotate like
// the vertex normal (docs/math.md, section 21; Sloan, Luna and Snyder, "Local, deformable precomputed
// radiance transfer", 2005). prt/fit/lobe_fit.h fits lobes, prt/gltf/transfer_gltf.h writes them to files,
// prt/load/model.h reads them; this header and shaders/prt_lobes.glsl evaluate them. Experimental.
//
//     const glm::mat3 rotation = axis_rotation(skin_matrix); // blended skin matrix of the vertex
//     std::array<Lobe, kMaxLobes> lobes;
//     model.decode(vertex, lobes);
//     for (Lobe& lobe : lobes)
//         lobe.axis = rotated_axis(lobe.axis, rotation);
//     const glm::vec3 radiance = albedo * lobe_radiance(lobes, light, model.order);

#include "prt/core/glm_layout.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

inline constexpr std::size_t kMaxLobes = 3, ///< maximum number of lobes per vertex
    kMaxProfiles = 256;                     ///< maximum number of profiles per model
/// Maximum number of bands of a lobe: the gains of a profile fit into a vec4 of a shader. It is also the
/// maximum order of the incident light of a volume.
inline constexpr int kMaxLobeOrder = 4;
/// Maximum magnitude of a gain of a profile in files. Valid gains are far smaller, even with all bounces.
inline constexpr float kMaxGain = 1e3f;

/// Response of a lobe to the light of each band: entry l is the gain of band l, and is 0 for bands from the
/// order of the model on. For example, the cosine lobe of an unoccluded receiver has the gains 1, 2/3, 1/4,
/// 0.
using LobeProfile = std::array<float, kMaxLobeOrder>;

/// Component of a grey transfer vector with rotational symmetry about an axis: its coefficient of band l and
/// degree m is profile[l] Y_lm(axis). By default all gains are 0.
struct Lobe {
    glm::vec3 axis{0, 0, 1}; ///< unit vector
    LobeProfile profile{};   ///< gain of each band
};

/// A lobe as stored per vertex. Bytes 0 and 1 are the axis (`coded_axis`), byte 2 is the index of the profile
/// in the model, and byte 3 divided by 255 is a factor for all gains of the profile.
using LobeWord = std::array<std::uint8_t, 4>;

/// Returns the octahedral coordinates x and y of a unit vector as bytes (Cigolle et al. 2014, "A survey of
/// efficient representations for independent unit vectors"). Byte 0 is the coordinate -1, 127 is 0 and 254 is
/// 1, so that the vectors ±x, ±y and ±z are exact. The maximum error of other vectors is 0.95 degrees.
std::array<std::uint8_t, 2> coded_axis(const glm::vec3& unit);
/// Returns the unit vector of the two bytes `x` and `y` of `coded_axis`. All byte values are valid; 255
/// counts as 254.
glm::vec3 decoded_axis(std::uint8_t x, std::uint8_t y);

/// The lobes of all vertices of a file.
struct LobeModel {
    int order = 0;                     ///< number of bands of all lobes, 2..kMaxLobeOrder; 0: empty model
    std::size_t lobes = 0;             ///< number of lobes per vertex, 1..kMaxLobes; 0: empty model
    std::vector<LobeProfile> profiles; ///< 1..kMaxProfiles profiles that the lobes of all vertices share
    /// [vertices][lobes] lobes of each vertex; axes are in the frame of the vertex normals of the unskinned
    /// mesh.
    std::vector<LobeWord> words;

    /// Returns the number of vertices.
    std::size_t vertices() const { return lobes == 0 ? 0 : words.size() / lobes; }
    /// Returns the lobe of a stored word. Does not check that its profile exists: see `check_lobes`.
    Lobe decode(const LobeWord& word) const;
    /// Writes the lobes of `vertex` to the first `lobes` entries of `to`; fills all further entries with
    /// lobes of gain 0. Does not check that profiles exist: see `check_lobes`.
    void decode(std::size_t vertex, std::span<Lobe> to) const;
};

/// Throws `Error` unless the order is in 2..kMaxLobeOrder, `lobes` is in 1..kMaxLobes, the number of profiles
/// is in 1..kMaxProfiles, all gains are finite and at most kMaxGain in magnitude, and the profile of every
/// word exists. An empty model is an error. Does not check the number of words.
void check_lobes(const LobeModel& model);

/// Returns the matrix that transforms the lobe axes of a vertex from its rest pose to its current pose, for
/// `rotated_axis`. `matrix` is the linear part of the blended skin matrix of the vertex, not necessarily a
/// rotation. Axes transform like normals, by the cofactors of `matrix` (negated if its determinant is
/// negative): in every pose, the axis of an unoccluded vertex is its normal.
glm::mat3 axis_rotation(const glm::mat3& matrix);
/// Returns the unit vector in the direction rotation · axis, with `rotation` the result of `axis_rotation`.
/// Returns `axis` if the length of that product is 0 or not finite.
glm::vec3 rotated_axis(const glm::vec3& axis, const glm::mat3& rotation);

/// Returns the exit radiance for albedo 1 of a vertex with these lobes; negative results become 0. `light`
/// [light_order²] contains the SH coefficients of distant or incident light in the frame of the axes. Only
/// bands below both `light_order` and kMaxLobeOrder contribute.
glm::vec3 lobe_radiance(std::span<const Lobe> lobes, std::span<const glm::vec3> light, int light_order);

/// Writes the sum of the lobes, a grey transfer vector in the frame of the axes, to `transfer` [order²].
/// `order` is in 1..kMaxLobeOrder; further bands of the lobes are ignored.
void lobe_transfer(std::span<const Lobe> lobes, int order, std::span<float> transfer);

} // namespace prt
