#pragma once

// The three 3D textures of a volume for shaders that include shaders/prt_volume.glsl. Only the light texture
// depends on the lighting. Experimental.
//
// In [depth][height][width], `width` is VolumeAtlas::visibility_texels().x, `height` is .y and `depth` is .z.
// `size` is VolumeGrid::size.
//
// light        RGBA16F or RGBA32F, [planes · depth][height][width]: each brick is a block of 5 x 5 x 5
//              texels, one per probe. A probe in several bricks has a texel in each of these bricks. A plane
//              contains four numbers of every probe; planes are stacked along z. The numbers of a probe are
//              the coefficients of incident light (r, g, b of coefficient 0, r of coefficient 1, ..), then
//              the visibility of a sun, 0..1.
// visibility   RG32UI, [depth][height][width]: visibility distances of each probe, in the same blocks.
// index        R32UI, [size.z][size.y][size.x]: for each cube of the size of a finest brick, the brick that
//              covers the cube.

#include "prt/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of texels along a side of a 3D texture that every implementation of OpenGL 3.3 and ES 3.0 supports.
/// The light and visibility textures of a VolumeAtlas never exceed it along x and y. Along z they can: a
/// light texture of order 3 exceeds it from 18 208 bricks on.
inline constexpr int kGuaranteedTexels = 256;

/// Positions of the bricks of a volume in its light and visibility textures.
struct VolumeAtlas {
    /// Number of bricks along each axis of one plane. Brick b of VolumeGrid::bricks is at
    /// (b mod x, b / x mod y, b / (x y)), in bricks; x, y and z are the components of `bricks`.
    glm::ivec3 bricks{0};
    int order = 0; ///< order of incident light, 2 to kMaxIncidentOrder; 0 only before initialisation

    /// Returns the number of SH coefficients of a probe, order².
    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    /// Returns the number of planes of the light texture. Each plane contains four numbers of every probe. A
    /// probe has three numbers per SH coefficient, and one for the sun.
    int planes() const { return (3 * coefficient_count(order) + 1 + 3) / 4; }
    /// Returns width, height and depth of the visibility texture in texels. One plane of the light texture
    /// has the same size.
    glm::ivec3 visibility_texels() const { return kBrickSide * bricks; }
    /// Returns width, height and depth of the light texture in texels, with all planes stacked along z.
    glm::ivec3 light_texels() const { return visibility_texels() * glm::ivec3(1, 1, planes()); }
    /// Returns the number of texels of one plane of the light texture, including texels without a brick.
    std::size_t texels_of_plane() const;
    /// Returns the texel of probe `i` of brick `brick` as an index into a plane [depth][height][width].
    /// `brick` is an index into VolumeGrid::bricks. `i` is 0 to kBrickProbes - 1; x varies fastest, then y,
    /// then z.
    std::size_t texel(std::size_t brick, std::size_t i) const;

    friend bool operator==(const VolumeAtlas&, const VolumeAtlas&) = default;
};

/// Returns the atlas for all bricks of `grid`. `order`: number of bands of incident light, 2 to
/// kMaxIncidentOrder.
VolumeAtlas atlas_of(const VolumeGrid& grid, int order);

/// Builds the visibility texture, [texels_of_plane()][2]. `probes`: probes_of(grid); `visibility`: [probes].
/// Four bytes of word 0, lowest first: the stored visibility distances along -x, +x, -y and +y. Four bytes of
/// word 1: the distances along -z and +z, the level of the probe minus the level of the brick, and a flag.
/// The flag belongs to the cell whose minimum corner is this probe. The flag is 1 if all eight probes of the
/// cell see the whole cell, so that shaders use trilinear weights there. Otherwise, and if the brick has no
/// cell at this corner, the flag is 0. Texels without a brick are 0.
std::vector<std::uint32_t> visibility_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                             std::span<const ProbeVisibility> visibility);

/// Builds the index texture, [size.z][size.y][size.x] with `size` of `grid`: 4 · brick + level of the brick,
/// or VolumeLookup::kNoBrick if no brick covers the entry. `index`: result of VolumeLookup::index for `grid`.
std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index);

} // namespace prt
