#pragma once

// The three textures of a volume for shaders (shaders/prt_volume.glsl). Only the light texture depends on the
// lighting. Experimental.
//
// light        RGBA16F or RGBA32F, [planes · depth][height][width]: bricks next to each other, five texels
//              along each side, one per probe. Planes are stacked along z. Each contains four numbers of
//              every probe: first the coefficients of incident light (r, g, b, r, ..), last the visibility of
//              a sun.
// visibility   RG32UI, [depth][height][width]: visibility distances of each probe.
// index        R32UI, [size.z][size.y][size.x]: the brick at each position of a finest brick.

#include "prt/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Maximum size of a 3D texture that every implementation of OpenGL 3.3 and ES 3.0 supports. An atlas never
/// exceeds it along x and y. Along z the light texture exceeds it from 18 208 bricks on (order 3).
inline constexpr int kGuaranteedTexels = 256;

/// Positions of the bricks of a volume in a texture.
struct VolumeAtlas {
    glm::ivec3 bricks{0}; ///< number along each axis: brick b is at (b mod x, b / x mod y, b / (x y))
    int order = 0;        ///< order of incident light

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    /// Number of planes with four numbers each: three numbers per coefficient, and one for the sun.
    int planes() const { return (3 * coefficient_count(order) + 1 + 3) / 4; }
    glm::ivec3 visibility_texels() const { return kBrickSide * bricks; }
    glm::ivec3 light_texels() const { return visibility_texels() * glm::ivec3(1, 1, planes()); }
    /// Returns the number of texels of one plane.
    std::size_t texels_of_plane() const;
    /// Returns the index of the texel of corner `i` of a brick; x varies fastest, then y, then z.
    std::size_t texel(std::size_t brick, std::size_t i) const;

    friend bool operator==(const VolumeAtlas&, const VolumeAtlas&) = default;
};

/// Returns the atlas for all bricks of `grid` and for incident light of `order` bands.
VolumeAtlas atlas_of(const VolumeGrid& grid, int order);

/// Builds the visibility texture, [texels_of_plane()][2]. The bytes of the first word are the visibility
/// distances along -x, +x, -y and +y. The bytes of the second word are those along -z and +z, the level of
/// the probe minus that of the brick, and a flag. The flag is 1 if all eight probes of the cell whose minimum
/// corner is this probe see the whole cell; weights in the cell are then trilinear.
std::vector<std::uint32_t> visibility_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                             std::span<const ProbeVisibility> visibility);

/// Builds the index texture, [size.z][size.y][size.x]: 4 · brick + level, or kNoBrick. `index` is the result
/// of VolumeLookup::index.
std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index);

} // namespace prt
