#pragma once

// Occlusion of nearby receivers by a rigid moving object ("occluder"): a box of 8 x 8 x 8 points, each with
// the fraction of all directions that the object blocks and with the mean of the blocked directions
// (docs/math.md, section 20). prt/bake/ambient_occlusion.h bakes the volume once; this header and
// shaders/prt_occluders.glsl evaluate it. Experimental.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of points along each side of an occlusion volume; the outer points are on the faces of its box.
inline constexpr int kOccluderSide = 8;
/// Number of points, and thus of texels, of an occlusion volume.
inline constexpr std::size_t kOccluderTexels = kOccluderSide * kOccluderSide * kOccluderSide;
/// Fraction of `OcclusionVolume::reach` up to which occlusion has full strength. Occlusion fades smoothly
/// from this distance to 0 at the reach.
inline constexpr float kOccluderFade = 0.6f;
/// Half width of the soft border of a blocked cap in `blocked_sun`, as a fraction of the angular radius of
/// the cap. `blocked_sun` adds the half angle of the sun to this width.
inline constexpr float kOccluderBorder = 0.4f;
/// Maximum number of objects in the list of a shader, unless the shader defines PRT_MAX_OCCLUDERS.
inline constexpr std::size_t kMaxOccluders = 32;

/// Directions that an object blocks, seen from a point, as a uniformly blocked spherical cap. The cap and the
/// object have the same blocked fraction of all directions, and the same mean of the blocked directions.
struct BlockedCap {
    glm::vec3 towards{0, 1, 0}; ///< unit direction from the point to the center of the cap
    float share = 0;   ///< size of the cap as a fraction of the whole sphere, 0..1; 0: nothing blocked
    float density = 0; ///< fraction of the light from within the cap that is blocked, 0..1
};

/// Returns the cap for two moments of the blocked directions. `blocked` is the blocked fraction of all
/// directions, 0..1; 0 results in a cap that blocks nothing. `blocked_direction` is the mean of the blocked
/// unit directions, divided by 1 - blocked: its length is 1 if the directions fill a cap, and less if they
/// are scattered. A length of 0 results in the whole sphere with density `blocked`; a length above 1 counts
/// as 1.
BlockedCap cap_of(float blocked, const glm::vec3& blocked_direction);

/// Returns the fraction, 0..1, by which the cap reduces the irradiance from uniform light on a receiver with
/// unit normal `normal`. The part of the cap below the receiver's horizon blocks nothing.
float blocked_cosine(const BlockedCap& cap, const glm::vec3& normal);

/// Returns the fraction of the light of a sun that the cap blocks, 0..1. `towards_sun` is the unit direction
/// to the center of the sun; `half_angle` is the angular radius of the sun in radians. The border of the cap
/// is soft (kOccluderBorder), because the cap does not have the outline of the object.
float blocked_sun(const BlockedCap& cap, const glm::vec3& towards_sun, float half_angle);

/// Stored values at one point of an occlusion volume, as signed bytes. With the arguments of `cap_of`, bytes
/// 0 to 2 are 127 times x, y and z of `blocked_direction`, and byte 3 is 127 (2 sqrt(blocked) - 1).
using OccluderTexel = std::array<std::int8_t, 4>;
/// Returns the stored values for `blocked` and `blocked_direction`, the arguments of `cap_of`. Rounds to the
/// nearest byte; clamps `blocked` to 0..1 and components of the direction to -1..1.
OccluderTexel occluder_texel(float blocked, const glm::vec3& blocked_direction);

/// Occlusion volume of an object, in the object's frame and its unit of length.
struct OcclusionVolume {
    glm::vec3 low{0}, ///< corner of the box with the smallest coordinates; the box is larger than the object
        high{0};      ///< corner of the box with the largest coordinates
    float reach = 0;  ///< distance from the center of the box beyond which the object blocks no light
    /// [z][y][x], each kOccluderSide: blocked directions seen from each point of the box.
    std::array<OccluderTexel, kOccluderTexels> texels{};
};

/// Throws `Error` unless the reach and all sides of the box are finite and greater than 0. Does not check the
/// texels: all byte values are valid.
void check_occlusion_volume(const OcclusionVolume& volume);

/// An occluder at its position in the world, in the layout of shaders (PrtOccluders of
/// shaders/prt_occluders.glsl). "Metres" are the unit of length of the world. `placed` computes all members.
/// If the matrix of the object has the determinant 0, to_box and half are 0, and the object blocks nothing.
struct PlacedOccluder {
    /// Rows of a 3 x 4 matrix. Row i times (position in the world, 1) is the signed distance from the center
    /// of the box along its side i, in metres.
    std::array<glm::vec4, 3> to_box;
    glm::vec4 half; ///< xyz: half of the size of the box along each side, in metres; w: the reach in metres
    glm::vec4 slot; ///< x: index of the volume in `occluder_texture`, an integer; yzw: 0

    /// Returns the center of the box in the world, in metres; the origin of the world if `to_box` is 0.
    glm::vec3 center() const;
    /// Returns the distance from `center` in metres beyond which the object blocks no light.
    float reach() const { return half.w; }
};

/// Returns the occluder `volume` at its position in the world. `to_world` maps the object's frame to the
/// world; it may rotate, translate and scale. `slot` is the index of `volume` in the argument of
/// `occluder_texture`. Under non-uniform scale, distances use the mean scale (the cube root of the
/// determinant's magnitude), and blocked directions are approximate. Does not check the arguments.
PlacedOccluder placed(const OcclusionVolume& volume, const glm::mat4& to_world, std::size_t slot);

/// Returns the cap of directions that an object blocks, seen from `position`. Position and directions are in
/// the frame of the world. `where` is the result of `placed` for `volume`. The cap blocks nothing if
/// `position` is at the reach or beyond it.
BlockedCap blocked_at(const OcclusionVolume& volume, const PlacedOccluder& where, const glm::vec3& position);

/// Returns up to `most` indices in `placed`: occluders that can block light in the box from corner `low` to
/// corner `high`, in the world. An occluder can block light if d is less than its reach, with d the distance
/// from the center of the occluder to the box. The list is in ascending order of d - reach; if there are more
/// than `most` occluders, the last ones of this order are omitted. It is for the shader that draws the
/// geometry in the box.
std::vector<std::uint32_t> occluders_near(std::span<const PlacedOccluder> placed, const glm::vec3& low,
                                          const glm::vec3& high, std::size_t most);

/// Returns the texels of the 3D texture for shaders, [8 · volumes][8][8] in the format RGBA8_SNORM: volume i
/// has the z coordinates 8 i to 8 i + 7. The texture needs linear filtering and clamping to the edge.
std::vector<OccluderTexel> occluder_texture(std::span<const OcclusionVolume> volumes);

} // namespace prt
