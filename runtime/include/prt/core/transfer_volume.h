#pragma once

// Volumes: transfer of probes in free space, which lights objects that move through a scene. A probe has the
// linear map from lighting to the incident light at its position, which is radiance from all directions as SH
// coefficients. Also the layout of the textures in which shaders look up a volume. Experimental.

#include "prt/core/baked_transfer.h"
#include "prt/core/light.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of cells along each side of a brick. A brick is a cube of 4³ cubic cells, with a probe at every
/// corner of a cell.
inline constexpr int kBrickCells = 4;
/// Number of probes along each side of a brick.
inline constexpr int kBrickSide = kBrickCells + 1;
/// Number of probes at the corners of the cells of one brick, including those that it shares with other
/// bricks.
inline constexpr std::size_t kBrickProbes = kBrickSide * kBrickSide * kBrickSide;
/// Maximum level of a brick: cells of this level are 2^3 times as wide as those of level 0, the finest.
inline constexpr int kMaxBrickLevel = 3;
/// Maximum size of a volume along each axis, in bricks of level 0.
inline constexpr int kMaxBricksAlong = 1024;
/// Maximum order of the incident light at a probe; the minimum is 2.
inline constexpr int kMaxIncidentOrder = 4;

/// Position and size of a brick of probes in a `VolumeGrid`.
struct VolumeBrick {
    /// Minimum corner relative to VolumeGrid::origin, in widths of a brick of level 0; each coordinate is 0
    /// or a positive multiple of 2^level, and less than that of VolumeGrid::size.
    glm::ivec3 position{0};
    int level = 0; ///< 0..kMaxBrickLevel; a cell is VolumeGrid::spacing · 2^level metres wide

    friend bool operator==(const VolumeBrick&, const VolumeBrick&) = default;
};

/// Geometry of a volume: a box that is aligned to the axes, and bricks that do not overlap. Each brick has
/// its minimum corner in the box; coarse bricks can extend beyond the box. Parts of the box may have no
/// brick.
struct VolumeGrid {
    /// Minimum corner of the box, metres, relative to Scene::origin (prt/load/scene.h).
    glm::vec3 origin{0};
    float spacing = 1;               ///< width of a cell of level 0, metres
    glm::ivec3 size{0};              ///< size of the box in bricks of level 0, 1..kMaxBricksAlong per axis
    std::vector<VolumeBrick> bricks; ///< at least one

    friend bool operator==(const VolumeGrid&, const VolumeGrid&) = default;
};

/// Throws `Error` if the grid is invalid: the spacing is not positive, the spacing or the origin is not
/// finite or too large, the size is not in 1..kMaxBricksAlong along each axis, there is no brick, or a brick
/// has an invalid level or position or overlaps another one.
void check_grid(const VolumeGrid& grid);

/// The probes of a grid. Corners of cells at the same position are one probe, also if they belong to several
/// bricks. Probes are numbered in the sequence of their first occurrence, brick by brick; in a brick x varies
/// fastest, then y, then z.
struct VolumeProbes {
    /// Hanging node: a probe of a fine brick on the face of a coarse brick, at a position that is not a
    /// corner of the cells of the coarse brick. The transfer of the probe must be interpolated from the
    /// probes of the coarse brick; otherwise light would jump across the face.
    struct Hanging {
        std::uint32_t probe; ///< index of the hanging probe
        std::uint32_t brick; ///< index of the coarse brick in VolumeGrid::bricks
    };
    /// [bricks][kBrickProbes] index of the probe at each corner of the cells of a brick: corner (x, y, z),
    /// each 0..4, is at (z · 5 + y) · 5 + x.
    std::vector<std::array<std::uint32_t, kBrickProbes>> of_brick;
    /// [probes] position relative to VolumeGrid::origin in widths of a cell of level 0, for `position_of`.
    std::vector<glm::ivec3> corners;
    /// [probes] level of the probe: that of the coarsest brick that has the probe at a corner of its cells.
    std::vector<std::uint8_t> levels;
    /// All hanging nodes, sorted by decreasing level of their coarse brick, so that interpolation in this
    /// sequence uses only final values.
    std::vector<Hanging> hanging;

    /// Number of probes.
    std::size_t size() const { return corners.size(); }
};
/// Returns the probes of `grid`. Throws `Error` if bricks overlap; does not check the other conditions of
/// `check_grid`, which are required.
VolumeProbes probes_of(const VolumeGrid& grid);

/// Returns the position of `corner`, an element of VolumeProbes::corners, in metres, relative to
/// Scene::origin (prt/load/scene.h).
inline glm::vec3 position_of(const VolumeGrid& grid, const glm::ivec3& corner) {
    return grid.origin + grid.spacing * glm::vec3(corner);
}

/// Visibility distances of a probe along -x, +x, -y, +y, -z, +z: distances to the nearest surfaces that block
/// the view from the probe. Each is stored as round(255 · sqrt(distance / (kVisibilityCells · c))), at most
/// 255, with c the width of a cell of the probe's level (VolumeProbes::levels). All six are 0 if the probe is
/// inside geometry. A point at offset d from the probe is hidden if, for an axis a, |d_a| exceeds the
/// visibility distance along a in the direction of the sign of d_a (docs/math.md, section 19).
using ProbeVisibility = std::array<std::uint8_t, 6>;
/// Maximum visibility distance that `ProbeVisibility` stores, in widths of a cell of the probe's level.
inline constexpr float kVisibilityCells = 4;

/// Returns the stored form of the visibility `distances`, metres, along -x, +x, -y, +y, -z, +z. `cell` is the
/// width of a cell of the probe's level, metres. Distances are clamped to 0..kVisibilityCells · cell.
ProbeVisibility visibility_of(const std::array<float, 6>& distances, float cell);
/// Returns the visibility distances, metres, along -x, +x, -y, +y, -z, +z from their stored form
/// `visibility`. `cell` is the width of a cell of the probe's level, metres.
std::array<float, 6> distances_of(const ProbeVisibility& visibility, float cell);

/// Positions of the probes of a volume, what they see, and the order of their incident light.
struct ProbeLayout {
    VolumeGrid grid;                         ///< box and bricks
    int order = 3;                           ///< order of incident light, 2..kMaxIncidentOrder
    std::vector<ProbeVisibility> visibility; ///< [probes] in the sequence of VolumeProbes

    /// Number of SH coefficients of the incident light at a probe, order².
    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
};

/// Volume with raw transfer, which a bake produces.
struct BakedVolume : ProbeLayout {
    /// Raw transfer. Its receivers are the coefficients of incident light of all probes, [probes][order²],
    /// with one output each: receiver p · order² + o has coefficient o of probe p.
    BakedTransfer baked;
};

/// Volume with compressed transfer, which a game loads.
struct CompressedVolume : ProbeLayout {
    CompressedTransfer compressed; ///< its receivers are the probes, with order² outputs and packed weights
};

/// Returns the SH coefficients of the incident light at every probe under `lighting`, [probes][order²], in
/// the unit of the radiance of `lighting`. `threads`: number of threads; 0: all hardware threads. Requires
/// packed weights. Throws `Error` if the layout of the transfer is invalid, and the errors of
/// `light_columns` (prt/core/transfer_layout.h). For a `BakedVolume`, `exit_radiance(volume.baked.transfer,
/// lighting)` of prt/core/transfer.h returns these coefficients without the error of compression.
std::vector<glm::vec3> incident_light(const CompressedVolume& volume, const Lighting& lighting,
                                      int threads = 0);

/// The eight probes at the corners of the cell that contains a position, and their weights in the light at
/// this position.
struct VolumeCorners {
    std::array<std::uint32_t, 8> probes{}; ///< index of each probe in VolumeProbes
    std::array<float, 8> weights{};        ///< weight of each of `probes`, 0..1; the sum is 1
};

/// Finds the probes that light a position. Probes that a surface hides from the position have almost no
/// weight, unless all eight are hidden. Owns a copy of its input. Immutable and thread-safe.
class VolumeLookup {
public:
    /// `visibility` is [probes], in the sequence of `probes_of(grid)`. Throws `Error` if `visibility` has
    /// another length, or if bricks overlap; does not check the other conditions of `check_grid`, which are
    /// required.
    VolumeLookup(const VolumeGrid& grid, std::span<const ProbeVisibility> visibility);

    /// Returns the probes of the grid.
    const VolumeProbes& probes() const { return probes_; }
    /// Returns the probes that light `position`, and their weights. `position` is in metres, relative to
    /// Scene::origin (prt/load/scene.h); a position outside the box is moved to the nearest point of the box.
    /// `normal` is the unit normal of the lit surface: the lookup uses the point at a distance of a quarter
    /// of a cell from `position` along `normal`, moved into the box. Zero (the default): no offset. The cell
    /// belongs to the brick that contains the point. If no brick contains the point, it is the nearest cell
    /// of the brick that contains `position`. If no brick contains `position`, it is the nearest cell of the
    /// first brick.
    VolumeCorners find(const glm::vec3& position, const glm::vec3& normal = glm::vec3(0)) const;
    /// Element of `index()` for a position that no brick covers.
    static constexpr std::uint32_t kNoBrick = ~0u;
    /// Returns an array over the box of the volume, divided into cubes of the size of a brick of level 0:
    /// [size.z][size.y][size.x]. Each element is the index in VolumeGrid::bricks of the brick that covers the
    /// cube, or kNoBrick.
    std::span<const std::uint32_t> index() const { return index_; }

private:
    VolumeGrid grid_;
    VolumeProbes probes_;
    std::vector<std::uint32_t> index_;
    /// [probes] 1 / visibility distance, per metre; kInvalidNearness (runtime/domains/volume_weights.h) if
    /// it is 0.
    std::vector<std::array<float, 6>> nearness_;
};

/// Interpolates the incident light at a position: writes the weighted sum of the incident light at the eight
/// probes of `corners`, a result of `VolumeLookup::find`, to `light` [coefficients]. `incident` is
/// [probes][coefficients]; the size of `light` determines the number of coefficients.
void mix_incident(const VolumeCorners& corners, std::span<const glm::vec3> incident,
                  std::span<glm::vec3> light);

/// Returns the irradiance, divided by pi, on a surface with unit normal `normal`; this is its exit radiance
/// for albedo 1 (Ramamoorthi and Hanrahan 2001). `incident` contains the 4, 9 or 16 SH coefficients of the
/// incident light; the result has the same unit. A channel that would be negative is 0.
glm::vec3 irradiance_of(std::span<const glm::vec3> incident, const glm::vec3& normal);

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
