#pragma once

// What an object that moves as one takes from the light of what is near it: a box of 8 x 8 x 8 places that
// know how much the object blocks of all directions, and where to (docs/math.md, section 20). Baked once by
// prt/occluder_bake.h, looked up here and by shaders/prt_occluders.glsl. Experimental.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Places along each side of a volume; the outer ones lie on the faces of its box.
inline constexpr int kOccluderSide = 8;
inline constexpr std::size_t kOccluderTexels = kOccluderSide * kOccluderSide * kOccluderSide;
/// Of its reach, from where on what an object blocks fades to nothing.
inline constexpr float kOccluderFade = 0.6f;
/// Of the radius of a blocked cap, how far to both sides its border is soft for suns.
inline constexpr float kOccluderBorder = 0.4f;
/// Objects in one list of a shader, where it says no other number.
inline constexpr std::size_t kMostOccluders = 32;

/// What is blocked of the directions from a place, as a cap of a sphere that is blocked evenly: it has the
/// share of all directions, and their mean, that the object has.
struct BlockedCap {
    glm::vec3 towards{0, 1, 0}; ///< unit, its middle
    float share = 0;            ///< of the whole sphere, 0..1
    float density = 0;          ///< how much of it is blocked, 0..1
};

/// Of `blocked` of all directions, 0..1; `lean`, at most 1 long: over blocked (1 - blocked) it is their mean,
/// so that a cap has length 1.
BlockedCap cap_of(float blocked, const glm::vec3& lean);

/// How much the cap takes of light from everywhere alike, by the cosine law, of a receiver with that unit
/// normal: 0..1. What of the cap is below the horizon takes none.
float blocked_cosine(const BlockedCap& cap, const glm::vec3& normal);

/// How much it takes of a sun of that half angle, radians. The cap's border is soft, as it stands for no
/// outline.
float blocked_sun(const BlockedCap& cap, const glm::vec3& towards_sun, float half_angle);

/// A place of a volume as it is stored: lean · 127, and 254 sqrt(blocked) - 127.
using OccluderTexel = std::array<std::int8_t, 4>;
OccluderTexel occluder_texel(float blocked, const glm::vec3& lean);

/// In the frame of an object.
struct OcclusionVolume {
    glm::vec3 low{0}, high{0}; ///< the box, larger than the object
    float reach = 0;           ///< how far from the middle of the box the object blocks anything
    std::array<OccluderTexel, kOccluderTexels> texels{}; ///< x before y before z
};

/// Throws `Error` unless box and reach are finite and above 0.
void check_occlusion_volume(const OcclusionVolume& volume);

/// An object where it stands, as shaders have it (PrtOccluders of shaders/prt_occluders.glsl).
struct PlacedOccluder {
    std::array<glm::vec4, 3> to_box; ///< rows: metres from the middle of the box along its sides
    glm::vec4 half;                  ///< of the box, metres; and the reach
    glm::vec4 slot;                  ///< in the texture, in x

    glm::vec3 center() const;
    float reach() const { return half.w; }
};

/// `to_world` turns, moves and scales the object's frame. Where it scales unevenly, directions are about
/// right alone: leans turn as normals do.
PlacedOccluder placed(const OcclusionVolume& volume, const glm::mat4& to_world, std::size_t slot);

/// What the object blocks at a position in the world.
BlockedCap blocked_at(const OcclusionVolume& volume, const PlacedOccluder& where, const glm::vec3& position);

/// Those whose reach comes into a box, nearest to its middle first, `most` at most: the list of a frame for
/// what is drawn there. Indices into `placed`.
std::vector<std::uint32_t> occluders_near(std::span<const PlacedOccluder> placed, const glm::vec3& low,
                                          const glm::vec3& high, std::size_t most);

/// The texture that shaders look up, RGBA8 signed and normalised, [8 · volumes][8][8]: one volume behind the
/// other along z. It filters linearly and clamps.
std::vector<OccluderTexel> occluder_texture(std::span<const OcclusionVolume> volumes);

} // namespace prt
