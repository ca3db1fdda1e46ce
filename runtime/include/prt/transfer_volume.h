#pragma once

// Transfer of probes in free space, which lights objects that move through a scene. A probe holds the linear
// map from lighting to incident light from all directions, as coefficients of spherical harmonics.
// Experimental.

#include "prt/baked_transfer.h"
#include "prt/light.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of cells along each side of a brick, which is a cube with a probe at every corner of a cell.
inline constexpr int kBrickCells = 4;
inline constexpr int kBrickSide = kBrickCells + 1;
inline constexpr std::size_t kBrickProbes = kBrickSide * kBrickSide * kBrickSide;
/// Level of the coarsest bricks: their cells are 2^3 times as wide as the finest.
inline constexpr int kMaxBrickLevel = 3;
/// Maximum number of bricks of the finest level along a side of a volume.
inline constexpr int kMaxBricksAlong = 1024;
/// Maximum number of bands of incident light; the minimum is 2.
inline constexpr int kMaxIncidentOrder = 4;

/// A brick of probes.
struct VolumeBrick {
    glm::ivec3 position{0}; ///< minimum corner, in finest bricks; a multiple of 2^level
    int level = 0;          ///< its cells are 2^level times as wide as the finest

    friend bool operator==(const VolumeBrick&, const VolumeBrick&) = default;
};

/// Layout of the probes: bricks that do not overlap, inside a box. Sizes and positions are in units of bricks
/// of the finest level (level 0).
struct VolumeGrid {
    glm::vec3 origin{0}; ///< minimum corner, metres, in the frame of Scene::origin
    float spacing = 1;   ///< distance of the finest probes, metres
    glm::ivec3 size{0};  ///< in finest bricks
    std::vector<VolumeBrick> bricks;

    friend bool operator==(const VolumeGrid&, const VolumeGrid&) = default;
};

/// Throws `Error` if bricks are outside the box or overlap, or if the box is too large.
void check_grid(const VolumeGrid& grid);

/// The probes of a grid, each once; bricks share probes at common corners. Probes are ordered brick by brick;
/// in a brick x varies fastest, then y, then z.
struct VolumeProbes {
    /// Hanging node: a probe of fine cells on the face of a coarse brick that has no probe there. Its light
    /// must be interpolated from the coarse probes, or it would jump across the face.
    struct Hanging {
        std::uint32_t probe;
        std::uint32_t brick; ///< the coarse brick
    };
    std::vector<std::array<std::uint32_t, kBrickProbes>> of_brick; ///< [bricks]
    std::vector<glm::ivec3> corners;  ///< [probes] in finest cells from the origin
    std::vector<std::uint8_t> levels; ///< [probes] level of the coarsest brick with this probe at a cell
                                      ///< corner
    std::vector<Hanging> hanging;     ///< hanging nodes of coarse bricks first

    std::size_t size() const { return corners.size(); }
};
/// Returns the probes of a grid.
VolumeProbes probes_of(const VolumeGrid& grid);

/// Returns the position of a corner in metres.
inline glm::vec3 position_of(const VolumeGrid& grid, const glm::ivec3& corner) {
    return grid.origin + grid.spacing * glm::vec3(corner);
}

/// Visibility distances of a probe along -x, +x, -y, +y, -z, +z, each stored as 255 · sqrt(distance /
/// (kVisibilityCells · c)), where c is the width of a cell of the probe's level. 0: the probe is inside
/// geometry. A point at offset d from the probe is hidden if |d_a| / distance_a exceeds 1 on any axis
/// (docs/math.md, section 19).
using ProbeVisibility = std::array<std::uint8_t, 6>;
/// Largest stored visibility distance, in cells of the probe's level.
inline constexpr float kVisibilityCells = 4;

/// Codes visibility distances in metres. `cell`: width of a cell of the probe's level, metres.
ProbeVisibility visibility_of(const std::array<float, 6>& distances, float cell);
/// Returns the visibility distances in metres. `cell`: width of a cell of the probe's level, metres.
std::array<float, 6> distances_of(const ProbeVisibility& visibility, float cell);

/// Volume as a bake produces it.
struct BakedVolume {
    VolumeGrid grid;
    int order = 3;                           ///< order of incident light
    std::vector<ProbeVisibility> visibility; ///< [probes]
    /// Receivers are coefficients of incident light, probe by probe: [probes][order²].
    BakedTransfer baked;

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
};

/// Volume as a game loads it: receivers are probes, with order² outputs each.
struct CompressedVolume {
    VolumeGrid grid;
    int order = 3;
    std::vector<ProbeVisibility> visibility;
    CompressedTransfer compressed;
};

/// Computes the coefficients of incident light at every probe, [probes][order²]. `exit_radiance` returns the
/// same for raw transfer.
std::vector<glm::vec3> incident_light(const CompressedVolume& volume, const Lighting& lighting,
                                      int threads = 0);

/// The probes that light a position, with weights of sum 1.
struct VolumeCorners {
    std::array<std::uint32_t, 8> probes{};
    std::array<float, 8> weights{};
};

/// Finds the probes around a position and excludes those behind surfaces. Copies its input; thread-safe.
class VolumeLookup {
public:
    VolumeLookup(const VolumeGrid& grid, std::span<const ProbeVisibility> visibility);

    const VolumeProbes& probes() const { return probes_; }
    /// Returns the probes for `position` in metres, clamped to the volume. `normal` is the unit normal of the
    /// lit surface, along which the lookup is offset; zero: no offset.
    VolumeCorners find(const glm::vec3& position, const glm::vec3& normal = glm::vec3(0)) const;
    /// Value of `index()` where there is no brick.
    static constexpr std::uint32_t kNoBrick = ~0u;
    /// Returns the index of the brick that covers each cell of a grid of finest bricks,
    /// [size.z][size.y][size.x]; kNoBrick if none does.
    std::span<const std::uint32_t> index() const { return index_; }

private:
    VolumeGrid grid_;
    VolumeProbes probes_;
    std::vector<std::uint32_t> index_;
    std::vector<std::array<float, 6>> nearness_; ///< [probes] 1 / distance, per metre
};

/// Interpolates `incident` [probes][coefficients] with the weights of `corners`; writes `light`
/// [coefficients].
void mix_incident(const VolumeCorners& corners, std::span<const glm::vec3> incident,
                  std::span<glm::vec3> light);

/// Returns irradiance divided by pi, which is exit radiance for albedo 1, of a surface with unit normal
/// `normal` (Ramamoorthi and Hanrahan 2001). `incident` has 4, 9 or 16 coefficients. The result is clamped to
/// 0.
glm::vec3 irradiance_of(std::span<const glm::vec3> incident, const glm::vec3& normal);

} // namespace prt
