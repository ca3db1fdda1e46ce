#pragma once

// Transfer of probes in free space: what lights objects that move through a scene. A probe holds the linear
// map from lighting to the light that comes in there from everywhere, as coefficients of spherical harmonics.
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

/// A brick is a cube of so many cells along each side, with a probe at every corner of a cell.
inline constexpr int kBrickCells = 4;
inline constexpr int kBrickSide = kBrickCells + 1;
inline constexpr std::size_t kBrickProbes = kBrickSide * kBrickSide * kBrickSide;
/// The coarsest cells are 2^3 times as wide as the finest.
inline constexpr int kMostBrickLevel = 3;
/// Bricks of the finest level along a side of a volume at most.
inline constexpr int kMostBricksAlong = 1024;
/// Bands of incident light: 2 to 4.
inline constexpr int kMostIncidentOrder = 4;

struct VolumeBrick {
    glm::ivec3 place{0}; ///< of its least corner, in finest bricks; a multiple of 2^level
    int level = 0;       ///< its cells are 2^level times as wide as the finest

    friend bool operator==(const VolumeBrick&, const VolumeBrick&) = default;
};

/// Where probes are: bricks that do not overlap, in a box of finest bricks.
struct VolumeGrid {
    glm::vec3 origin{0}; ///< least corner, metres, in the frame of Scene::origin
    float spacing = 1;   ///< of the finest probes, metres
    glm::ivec3 size{0};  ///< in finest bricks
    std::vector<VolumeBrick> bricks;

    friend bool operator==(const VolumeGrid&, const VolumeGrid&) = default;
};

/// Throws `Error` where bricks lie outside, overlap, or the box is too large.
void check_grid(const VolumeGrid& grid);

/// The probes of a grid: corners that bricks share are one. In the order of bricks, and in a brick x before y
/// before z.
struct VolumeProbes {
    /// A probe of fine cells on the face of coarse ones, where these have none: light there has to be what
    /// is interpolated between theirs, or it would jump.
    struct Hanging {
        std::uint32_t probe;
        std::uint32_t brick; ///< of the coarse cells
    };
    std::vector<std::array<std::uint32_t, kBrickProbes>> of_brick; ///< [bricks]
    std::vector<glm::ivec3> corners;  ///< [probes] in finest cells from the origin
    std::vector<std::uint8_t> levels; ///< [probes] of the coarsest brick that has it at a corner of a cell
    std::vector<Hanging> hanging;     ///< coarse bricks first

    std::size_t size() const { return corners.size(); }
};
VolumeProbes probes_of(const VolumeGrid& grid);

/// In metres.
inline glm::vec3 position_of(const VolumeGrid& grid, const glm::ivec3& corner) {
    return grid.origin + grid.spacing * glm::vec3(corner);
}

/// How far a probe sees along -x, +x, -y, +y, -z, +z: 255 · sqrt(distance / (kSightCells cells)), a cell
/// being as wide as those of the probe's level; 0: it is inside of something. What lies at d
/// from the probe is hidden where |d_a| / distance_a exceeds 1 on any axis (docs/math.md, section 19).
using ProbeSight = std::array<std::uint8_t, 6>;
inline constexpr float kSightCells = 4;

ProbeSight sight_of(const std::array<float, 6>& distances, float cell);
std::array<float, 6> distances_of(const ProbeSight& sight, float cell);

/// As a bake makes it.
struct BakedVolume {
    VolumeGrid grid;
    int order = 3;                  ///< of incident light
    std::vector<ProbeSight> sights; ///< [probes]
    /// Receivers are coefficients of incident light, probe by probe: [probes][order²].
    BakedTransfer baked;

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
};

/// As a game loads it: receivers are probes, transfer of `order`² outputs each.
struct CompressedVolume {
    VolumeGrid grid;
    int order = 3;
    std::vector<ProbeSight> sights;
    CompressedTransfer compressed;
};

/// Coefficients of incident light, [probes][order²]: the rows of exit_radiance of raw transfer.
std::vector<glm::vec3> incident_light(const CompressedVolume& volume, const Lighting& lighting,
                                      int threads = 0);

/// Probes that light a place, with what each counts: together 1.
struct VolumeCorners {
    std::array<std::uint32_t, 8> probes{};
    std::array<float, 8> weights{};
};

/// Finds the probes around a place, those behind surfaces left out. Copies what it needs; thread-safe.
class VolumeLookup {
public:
    VolumeLookup(const VolumeGrid& grid, std::span<const ProbeSight> sights);

    const VolumeProbes& probes() const { return probes_; }
    /// `position` in metres; outside of the volume that of its border. `normal` (zero: none) is that of the
    /// surface that is lit, off which it is looked up.
    VolumeCorners find(const glm::vec3& position, const glm::vec3& normal = glm::vec3(0)) const;
    /// Brick of a place, as `index` [size.z][size.y][size.x] has it; kNoBrick where there is none.
    static constexpr std::uint32_t kNoBrick = ~0u;
    std::span<const std::uint32_t> index() const { return index_; }

private:
    VolumeGrid grid_;
    VolumeProbes probes_;
    std::vector<std::uint32_t> index_;
    std::vector<std::array<float, 6>> nearness_; ///< [probes] 1 / distance, per metre
};

/// Of a place from what comes in at probes, [probes][coefficients]; `light` [coefficients].
void mix_incident(const VolumeCorners& corners, std::span<const glm::vec3> incident,
                  std::span<glm::vec3> light);

/// Irradiance over pi of a surface that faces unit `normal`, from coefficients of incident light of 4, 9 or
/// 16: exit radiance for albedo 1 (Ramamoorthi and Hanrahan 2001). Not below 0.
glm::vec3 irradiance_of(std::span<const glm::vec3> incident, const glm::vec3& normal);

} // namespace prt
