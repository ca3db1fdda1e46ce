#pragma once

// A volume as shaders look it up (shaders/prt_volume.glsl): three textures, of which a change of light
// changes one. Experimental.
//
// light    RGBA16F or RGBA32F, [planes · depth][height][width]: bricks side by side, five texels along each
//          side, a probe each. Planes stand one behind the other along z and hold four numbers each:
//          coefficients of incident light (r, g, b, r, ..), and behind them how much of a sun is seen.
// sights   RG32UI, [depth][height][width]: how far each probe sees.
// index    R32UI, [size.z][size.y][size.x]: which brick a place is in.

#include "prt/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Texels along a side of a 3D texture that OpenGL 3.3 and ES 3.0 guarantee. Along x and y an atlas keeps to
/// it; along z light of more than 18 207 bricks (order 3) wants more.
inline constexpr int kGuaranteedTexels = 256;

/// Where the bricks of a volume are in a texture.
struct VolumeAtlas {
    glm::ivec3 bricks{0}; ///< along each side: brick b is at (b mod x, b / x mod y, b / (x y))
    int order = 0;        ///< of incident light

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    /// Of four numbers: three for each coefficient, and the sun.
    int planes() const { return (3 * coefficient_count(order) + 1 + 3) / 4; }
    glm::ivec3 sight_texels() const { return kBrickSide * bricks; }
    glm::ivec3 light_texels() const { return sight_texels() * glm::ivec3(1, 1, planes()); }
    std::size_t texels_of_plane() const;
    /// Number of the texel of corner `i` of a brick, x before y before z.
    std::size_t texel(std::size_t brick, std::size_t i) const;

    friend bool operator==(const VolumeAtlas&, const VolumeAtlas&) = default;
};

VolumeAtlas atlas_of(const VolumeGrid& grid, int order);

/// [texels_of_plane()][2]: bytes -x, +x, -y, +y, then -z, +z, the level of the probe less that of the brick,
/// and 1 where all eight corners of the cell above see all of it: there weights are trilinear.
std::vector<std::uint32_t> sight_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                        std::span<const ProbeSight> sights);

/// [size.z][size.y][size.x]: 4 · brick + level; kNoBrick where there is none. `index` as VolumeLookup has it.
std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index);

} // namespace prt
