#pragma once

// The three textures of a volume for shaders (shaders/prt_volume.glsl). A change of the lighting changes only
// one. Experimental.
//
// light    RGBA16F or RGBA32F, [planes · depth][height][width]: bricks next to each other, five texels along
//          each side, one per probe. Planes are stacked along z and hold four numbers each: coefficients of
//          incident light (r, g, b, r, ..), followed by the visibility of a sun.
// visibility   RG32UI, [depth][height][width]: visibility distances of each probe.
// index    R32UI, [size.z][size.y][size.x]: the brick at each position.

#include "prt/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Size of a 3D texture that OpenGL 3.3 and ES 3.0 guarantee. Along x and y an atlas never exceeds it. Along
/// z, light of more than 18 207 bricks (order 3) exceeds it.
inline constexpr int kGuaranteedTexels = 256;

/// Positions of the bricks of a volume in a texture.
struct VolumeAtlas {
    glm::ivec3 bricks{0}; ///< number along each axis: brick b is at (b mod x, b / x mod y, b / (x y))
    int order = 0;        ///< order of incident light

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    /// Number of planes of four numbers: three per coefficient, and the sun.
    int planes() const { return (3 * coefficient_count(order) + 1 + 3) / 4; }
    glm::ivec3 visibility_texels() const { return kBrickSide * bricks; }
    glm::ivec3 light_texels() const { return visibility_texels() * glm::ivec3(1, 1, planes()); }
    std::size_t texels_of_plane() const;
    /// Returns the index of the texel of corner `i` of a brick; x varies fastest, then y, then z.
    std::size_t texel(std::size_t brick, std::size_t i) const;

    friend bool operator==(const VolumeAtlas&, const VolumeAtlas&) = default;
};

VolumeAtlas atlas_of(const VolumeGrid& grid, int order);

/// Builds the visibility texture, [texels_of_plane()][2]: bytes -x, +x, -y, +y, then -z, +z, the level of the
/// probe minus that of the brick, and 1 if all eight corners of the cell above see the whole cell; its
/// weights are then trilinear.
std::vector<std::uint32_t> visibility_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                             std::span<const ProbeVisibility> visibility);

/// Builds the index texture, [size.z][size.y][size.x]: 4 · brick + level, or kNoBrick. `index` as in
/// VolumeLookup.
std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index);

} // namespace prt
