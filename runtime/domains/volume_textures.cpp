// Builds the texture layouts of volumes for shaders.
#include "prt/core/transfer_volume.h"

#include "runtime/domains/volume_weights.h"

#include <algorithm>

namespace prt {
namespace {

/// Returns whether a probe at corner `step` of a cell of width 1 sees the whole cell, with tolerance for
/// rounding.
bool sees_cell(const std::array<float, 6>& distances, const glm::ivec3& step) {
    constexpr float kRoom = 1e-3f;
    float passed = 0; // at the opposite corner
    for (int a = 0; a < 3; ++a) {
        const float distance = distances[static_cast<std::size_t>(2 * a + (step[a] == 0 ? 1 : 0))];
        passed = std::max(passed, distance > 0 ? 1 / distance : kInvalidNearness);
    }
    return passed <= kVisibilityFull - kRoom;
}

/// Distances of the probes of a brick, in cells of the brick.
struct BrickVisibility {
    std::array<std::array<float, 6>, kBrickProbes> distances;

    bool cell_is_seen(const glm::ivec3& low) const {
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 step(i & 1, i >> 1 & 1, i >> 2), corner = low + step;
            const int number = (corner.z * kBrickSide + corner.y) * kBrickSide + corner.x;
            if (!sees_cell(distances[static_cast<std::size_t>(number)], step))
                return false;
        }
        return true;
    }
};

glm::ivec3 corner_of(std::size_t i) {
    const int n = static_cast<int>(i);
    return {n % kBrickSide, n / kBrickSide % kBrickSide, n / (kBrickSide * kBrickSide)};
}

} // namespace

std::size_t VolumeAtlas::texels_of_plane() const {
    const glm::ivec3 texels = visibility_texels();
    return static_cast<std::size_t>(texels.x) * static_cast<std::size_t>(texels.y) *
           static_cast<std::size_t>(texels.z);
}

std::size_t VolumeAtlas::texel(std::size_t brick, std::size_t i) const {
    const auto x = static_cast<std::size_t>(bricks.x), y = static_cast<std::size_t>(bricks.y);
    const glm::ivec3 corner = corner_of(i);
    const std::size_t position[3] = {kBrickSide * (brick % x) + static_cast<std::size_t>(corner.x),
                                     kBrickSide * (brick / x % y) + static_cast<std::size_t>(corner.y),
                                     kBrickSide * (brick / (x * y)) + static_cast<std::size_t>(corner.z)};
    return (position[2] * kBrickSide * y + position[1]) * kBrickSide * x + position[0];
}

VolumeAtlas atlas_of(const VolumeGrid& grid, int order) {
    constexpr int kMaxAlong = kGuaranteedTexels / kBrickSide;
    const auto count = static_cast<int>(grid.bricks.size());
    const auto divided = [](int n, int by) { return (n + by - 1) / by; };
    // Use the minimum number of layers, then the row count that leaves the fewest texels unused.
    const int z = std::max(1, divided(count, kMaxAlong * kMaxAlong)),
              y = std::max(1, divided(count, kMaxAlong * z));
    return {{std::max(1, divided(count, y * z)), y, z}, order};
}

std::vector<std::uint32_t> visibility_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                             std::span<const ProbeVisibility> visibility) {
    const VolumeAtlas atlas = atlas_of(grid, 2); // the size does not depend on the order
    std::vector<std::uint32_t> texels(2 * atlas.texels_of_plane());
    for (std::size_t b = 0; b < grid.bricks.size(); ++b) {
        const auto& of_brick = probes.of_brick[b];
        BrickVisibility seen;
        std::array<std::uint32_t, kBrickProbes> coarser;
        for (std::size_t i = 0; i < kBrickProbes; ++i) {
            coarser[i] = static_cast<std::uint32_t>(probes.levels[of_brick[i]] - grid.bricks[b].level);
            seen.distances[i] = distances_of(visibility[of_brick[i]], static_cast<float>(1u << coarser[i]));
        }
        for (std::size_t i = 0; i < kBrickProbes; ++i) {
            const ProbeVisibility& s = visibility[of_brick[i]];
            const glm::ivec3 low = corner_of(i);
            const bool is_cell = std::max({low.x, low.y, low.z}) < kBrickCells;
            std::uint32_t* const texel = &texels[2 * atlas.texel(b, i)];
            texel[0] = s[0] | static_cast<std::uint32_t>(s[1]) << 8 | static_cast<std::uint32_t>(s[2]) << 16 |
                       static_cast<std::uint32_t>(s[3]) << 24;
            texel[1] = s[4] | static_cast<std::uint32_t>(s[5]) << 8 | coarser[i] << 16 |
                       static_cast<std::uint32_t>(is_cell && seen.cell_is_seen(low)) << 24;
        }
    }
    return texels;
}

std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index) {
    std::vector<std::uint32_t> texels(index.begin(), index.end());
    for (std::uint32_t& texel : texels)
        if (texel != VolumeLookup::kNoBrick)
            texel = 4 * texel + static_cast<std::uint32_t>(grid.bricks[texel].level);
    return texels;
}

} // namespace prt
