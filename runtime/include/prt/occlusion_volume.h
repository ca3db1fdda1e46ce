#pragma once

// Occlusion of nearby receivers by a rigid moving object: a box of 8 x 8 x 8 points, each with the fraction
// of directions that the object blocks and their mean direction (docs/math.md, section 20). Baked once by
// prt/occluder_bake.h, evaluated here and by shaders/prt_occluders.glsl. Experimental.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of points along each side of a volume; the outer ones are on the faces of its box.
inline constexpr int kOccluderSide = 8;
inline constexpr std::size_t kOccluderTexels = kOccluderSide * kOccluderSide * kOccluderSide;
/// Occlusion fades to zero from this fraction of the reach outwards.
inline constexpr float kOccluderFade = 0.6f;
/// Half width of the soft border of a blocked cap for suns, as a fraction of the cap's radius.
inline constexpr float kOccluderBorder = 0.4f;
/// Default maximum number of objects in the list of a shader.
inline constexpr std::size_t kMaxOccluders = 32;

/// Blocked directions seen from a point, as a uniformly blocked spherical cap. It has the same blocked
/// fraction of all directions, and the same mean direction, as the object.
struct BlockedCap {
    glm::vec3 towards{0, 1, 0}; ///< unit direction to the center of the cap
    float share = 0;            ///< fraction of the whole sphere, 0..1
    float density = 0;          ///< blocked fraction of the cap, 0..1
};

/// Builds the cap from `blocked`, the blocked fraction of all directions, 0..1, and from `blocked_direction`,
/// the mean of the blocked directions divided by 1 - blocked. The latter has length 1 if the blocked
/// directions fill a cap, and is shorter if they are scattered.
BlockedCap cap_of(float blocked, const glm::vec3& blocked_direction);

/// Returns the fraction of uniform incident light, 0..1, that the cap blocks for a receiver with the given
/// unit normal, weighted by the cosine. The part of the cap below the horizon blocks nothing.
float blocked_cosine(const BlockedCap& cap, const glm::vec3& normal);

/// Returns the fraction of a sun that the cap blocks, 0..1. `towards_sun`: unit direction to its center;
/// `half_angle`: its half angle in radians. The border of the cap is soft, because it is not an outline of
/// the object.
float blocked_sun(const BlockedCap& cap, const glm::vec3& towards_sun, float half_angle);

/// Stored values at one point of a volume, as signed bytes: 127 times each component of `blocked_direction`,
/// then 127 (2 sqrt(blocked) - 1).
using OccluderTexel = std::array<std::int8_t, 4>;
/// Returns the stored values for the arguments of `cap_of`.
OccluderTexel occluder_texel(float blocked, const glm::vec3& blocked_direction);

/// Occlusion volume in the frame of an object.
struct OcclusionVolume {
    glm::vec3 low{0}, high{0}; ///< the box, larger than the object
    float reach = 0;           ///< maximum distance from the center of the box at which the object blocks
                               ///< light
    std::array<OccluderTexel, kOccluderTexels> texels{}; ///< x varies fastest, then y, then z
};

/// Throws `Error` unless box size and reach are finite and positive.
void check_occlusion_volume(const OcclusionVolume& volume);

/// An occluder at its position in the world, in the layout of shaders (PrtOccluders of
/// shaders/prt_occluders.glsl).
struct PlacedOccluder {
    std::array<glm::vec4, 3> to_box; ///< rows: metres from the center of the box along its sides
    glm::vec4 half;                  ///< half size of the box in metres; w: the reach
    glm::vec4 slot;                  ///< x: index in the texture

    glm::vec3 center() const;
    float reach() const { return half.w; }
};

/// Returns the occluder `volume` at its position in the world. `to_world` rotates, translates and scales the
/// object's frame; `slot` is the index in `occluder_texture`. Under non-uniform scale the blocked directions
/// are approximate, because they are transformed like normals.
PlacedOccluder placed(const OcclusionVolume& volume, const glm::mat4& to_world, std::size_t slot);

/// Returns the cap of directions that the object blocks as seen from `position` in the world.
BlockedCap blocked_at(const OcclusionVolume& volume, const PlacedOccluder& where, const glm::vec3& position);

/// Returns the indices in `placed` of up to `most` occluders whose reach intersects the box from `low` to
/// `high`, nearest to its center first. The shader gets this list when the geometry in the box is drawn.
std::vector<std::uint32_t> occluders_near(std::span<const PlacedOccluder> placed, const glm::vec3& low,
                                          const glm::vec3& high, std::size_t most);

/// Builds the texture for shaders, RGBA8_SNORM, [8 · volumes][8][8]: volumes are stacked along z. It needs
/// linear filtering and clamping.
std::vector<OccluderTexel> occluder_texture(std::span<const OcclusionVolume> volumes);

} // namespace prt
