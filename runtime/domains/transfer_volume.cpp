// The probes of a volume, their visibility, and lookup of the probes that light a position.

#include "prt/core/transfer_volume.h"

#include "prt/core/cluster_lighting.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/counted.h"
#include "runtime/domains/volume_weights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace prt {
namespace {

std::size_t entry_of(const VolumeGrid& grid, const glm::ivec3& point) {
    return (static_cast<std::size_t>(point.z) * static_cast<std::size_t>(grid.size.y) +
            static_cast<std::size_t>(point.y)) *
               static_cast<std::size_t>(grid.size.x) +
           static_cast<std::size_t>(point.x);
}

/// Calls `visit` with the index of every finest brick that `brick` covers inside the box.
template <class Visit>
void for_each_entry(const VolumeGrid& grid, const VolumeBrick& brick, Visit&& visit) {
    const glm::ivec3 end = glm::min(brick.position + (1 << brick.level), grid.size);
    for (int z = brick.position.z; z < end.z; ++z)
        for (int y = brick.position.y; y < end.y; ++y)
            for (int x = brick.position.x; x < end.x; ++x)
                visit(entry_of(grid, {x, y, z}));
}

std::vector<std::uint32_t> index_of(const VolumeGrid& grid) {
    std::vector<std::uint32_t> index(static_cast<std::size_t>(grid.size.x) *
                                         static_cast<std::size_t>(grid.size.y) *
                                         static_cast<std::size_t>(grid.size.z),
                                     VolumeLookup::kNoBrick);
    for (std::size_t b = 0; b < grid.bricks.size(); ++b)
        for_each_entry(grid, grid.bricks[b], [&](std::size_t entry) {
            if (index[entry] != VolumeLookup::kNoBrick)
                throw Error("two bricks of a volume overlap");
            index[entry] = static_cast<std::uint32_t>(b);
        });
    return index;
}

/// Returns corner `i` of a brick, in finest cells.
glm::ivec3 corner_of(const VolumeBrick& brick, std::size_t i) {
    const auto n = static_cast<int>(i);
    return kBrickCells * brick.position + (1 << brick.level) * glm::ivec3(n % kBrickSide,
                                                                          n / kBrickSide % kBrickSide,
                                                                          n / (kBrickSide * kBrickSide));
}

struct LessCorner {
    bool operator()(const glm::ivec3& a, const glm::ivec3& b) const {
        return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
    }
};

/// The coarsest brick that contains a corner, also on its boundary.
struct Coarsest {
    std::uint32_t brick = VolumeLookup::kNoBrick;
    int level = -1;
};

Coarsest coarsest_around(const VolumeGrid& grid, std::span<const std::uint32_t> index,
                         const glm::ivec3& corner) {
    Coarsest found;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 inside = corner - glm::ivec3(i & 1, i >> 1 & 1, i >> 2); // an adjacent cell
        if (glm::any(glm::lessThan(inside, glm::ivec3(0))))
            continue;
        const glm::ivec3 point = inside / kBrickCells;
        if (glm::any(glm::greaterThanEqual(point, grid.size)))
            continue;
        const std::uint32_t b = index[entry_of(grid, point)];
        if (b != VolumeLookup::kNoBrick && grid.bricks[b].level > found.level)
            found = {b, grid.bricks[b].level};
    }
    return found;
}

bool has_corner(const VolumeBrick& brick, const glm::ivec3& corner) {
    return (corner - kBrickCells * brick.position) % (1 << brick.level) == glm::ivec3(0);
}

} // namespace

void check_grid(const VolumeGrid& grid) {
    if (!(grid.spacing > 0) || !(grid.spacing < 1e18f) || !(glm::length(grid.origin) < 1e30f))
        throw Error("the spacing or the origin of a volume is not finite, too large or not positive");
    if (glm::any(glm::lessThan(grid.size, glm::ivec3(1))) ||
        glm::any(glm::greaterThan(grid.size, glm::ivec3(kMaxBricksAlong))))
        throw Error("each side of a volume must have 1.." + std::to_string(kMaxBricksAlong) + " bricks");
    if (grid.bricks.empty())
        throw Error("a volume has no bricks");
    for (const VolumeBrick& brick : grid.bricks)
        if (brick.level < 0 || brick.level > kMaxBrickLevel ||
            glm::any(glm::lessThan(brick.position, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(brick.position, grid.size)) ||
            brick.position % (1 << brick.level) != glm::ivec3(0))
            throw Error("a brick is outside its volume, or its level or position is invalid");
    index_of(grid);
}

VolumeProbes probes_of(const VolumeGrid& grid) {
    const std::vector<std::uint32_t> index = index_of(grid);
    VolumeProbes probes;
    std::map<glm::ivec3, std::uint32_t, LessCorner> numbers;
    std::vector<Coarsest> around;
    for (const VolumeBrick& brick : grid.bricks) {
        auto& of_brick = probes.of_brick.emplace_back();
        for (std::size_t i = 0; i < kBrickProbes; ++i) {
            const glm::ivec3 corner = corner_of(brick, i);
            const auto [found, is_new] =
                numbers.try_emplace(corner, static_cast<std::uint32_t>(probes.size()));
            of_brick[i] = found->second;
            if (is_new) {
                probes.corners.push_back(corner);
                probes.levels.push_back(static_cast<std::uint8_t>(brick.level));
                around.push_back(coarsest_around(grid, index, corner));
            } else {
                std::uint8_t& level = probes.levels[found->second];
                level = std::max(level, static_cast<std::uint8_t>(brick.level));
            }
        }
    }
    // Corners of a brick that extends beyond the box may have no adjacent brick in the box.
    for (std::uint32_t p = 0; p < probes.size(); ++p)
        if (around[p].brick != VolumeLookup::kNoBrick &&
            !has_corner(grid.bricks[around[p].brick], probes.corners[p]))
            probes.hanging.push_back({p, around[p].brick});
    std::ranges::stable_sort(probes.hanging, std::ranges::greater(),
                             [&](const VolumeProbes::Hanging& h) { return grid.bricks[h.brick].level; });
    return probes;
}

ProbeVisibility visibility_of(const std::array<float, 6>& distances, float cell) {
    ProbeVisibility visibility{};
    for (std::size_t a = 0; a < 6; ++a)
        visibility[a] = static_cast<std::uint8_t>(
            std::lround(255 * std::sqrt(std::clamp(distances[a] / (kVisibilityCells * cell), 0.0f, 1.0f))));
    return visibility;
}

std::array<float, 6> distances_of(const ProbeVisibility& visibility, float cell) {
    std::array<float, 6> distances{};
    for (std::size_t a = 0; a < 6; ++a) {
        const float root = static_cast<float>(visibility[a]) / 255;
        distances[a] = kVisibilityCells * cell * root * root;
    }
    return distances;
}

VolumeCorners corners_in(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t brick,
                         const glm::vec3& position) {
    const VolumeBrick& in = grid.bricks[brick];
    const float cell = grid.spacing * static_cast<float>(1 << in.level);
    const glm::vec3 least = position_of(grid, kBrickCells * in.position);
    const glm::vec3 at = glm::clamp((position - least) / cell, glm::vec3(0), glm::vec3(kBrickCells));
    const glm::ivec3 low = glm::min(glm::ivec3(at), glm::ivec3(kBrickCells - 1));
    const glm::vec3 share = at - glm::vec3(low);
    VolumeCorners corners;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 step(i & 1, i >> 1 & 1, i >> 2), corner = low + step;
        const glm::vec3 weight = glm::mix(1.0f - share, share, glm::vec3(step));
        corners.probes[static_cast<std::size_t>(i)] = probes.of_brick[brick][static_cast<std::size_t>(
            (corner.z * kBrickSide + corner.y) * kBrickSide + corner.x)];
        corners.weights[static_cast<std::size_t>(i)] = weight.x * weight.y * weight.z;
    }
    return corners;
}

VolumeLookup::VolumeLookup(const VolumeGrid& grid, std::span<const ProbeVisibility> visibility)
    : grid_(grid), probes_(probes_of(grid)), index_(index_of(grid)) {
    if (visibility.size() != probes_.size())
        throw Error("the volume has " + counted(probes_.size(), "probe") + ", but visibility distances for " +
                    std::to_string(visibility.size()));
    for (std::size_t p = 0; p < visibility.size(); ++p) {
        auto& nearness = nearness_.emplace_back();
        const auto distances =
            distances_of(visibility[p], grid.spacing * static_cast<float>(1 << probes_.levels[p]));
        for (std::size_t a = 0; a < 6; ++a)
            nearness[a] = distances[a] > 0 ? 1 / distances[a] : kInvalidNearness;
    }
}

VolumeCorners VolumeLookup::find(const glm::vec3& position, const glm::vec3& normal) const {
    const glm::vec3 extent = grid_.spacing * static_cast<float>(kBrickCells) * glm::vec3(grid_.size);
    const auto brick_of = [&](const glm::vec3& at) {
        const glm::vec3 bricks = (at - grid_.origin) / (grid_.spacing * static_cast<float>(kBrickCells));
        return glm::clamp(glm::ivec3(glm::floor(bricks)), glm::ivec3(0), grid_.size - 1);
    };
    const glm::vec3 inside = glm::clamp(position, grid_.origin, grid_.origin + extent);
    std::uint32_t brick = index_[entry_of(grid_, brick_of(inside))];
    if (brick == kNoBrick)
        brick = 0;
    const float cell = grid_.spacing * static_cast<float>(1 << grid_.bricks[brick].level);
    const glm::vec3 seen =
        glm::clamp(inside + kNormalBias * cell * normal, grid_.origin, grid_.origin + extent);
    if (const std::uint32_t there = index_[entry_of(grid_, brick_of(seen))]; there != kNoBrick)
        brick = there;
    VolumeCorners corners = corners_in(grid_, probes_, brick, seen);
    float sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        const std::uint32_t p = corners.probes[i];
        const glm::vec3 from = seen - position_of(grid_, probes_.corners[p]);
        corners.weights[i] *= visibility_weight(nearness_[p], from);
        sum += corners.weights[i];
    }
    for (float& weight : corners.weights)
        weight /= sum;
    return corners;
}

void mix_incident(const VolumeCorners& corners, std::span<const glm::vec3> incident,
                  std::span<glm::vec3> light) {
    std::ranges::fill(light, glm::vec3(0));
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t o = 0; o < light.size(); ++o)
            light[o] += corners.weights[i] * incident[corners.probes[i] * light.size() + o];
}

glm::vec3 irradiance_of(std::span<const glm::vec3> incident, const glm::vec3& normal) {
    const int order = static_cast<int>(std::lround(std::sqrt(static_cast<double>(incident.size()))));
    std::array<float, kMaxIncidentOrder * kMaxIncidentOrder> basis{};
    evaluate_sh(order, normal, std::span(basis).first(incident.size()));
    // The clamped cosine over pi per band: 1, 2/3, 1/4, 0.
    constexpr std::array<float, kMaxIncidentOrder> kCosine = {1, 2.0f / 3, 0.25f, 0};
    glm::vec3 sum(0);
    for (int l = 0; l < order; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i)
            sum += kCosine[static_cast<std::size_t>(l)] * basis[static_cast<std::size_t>(i)] *
                   incident[static_cast<std::size_t>(i)];
    return glm::max(sum, glm::vec3(0));
}

std::vector<glm::vec3> incident_light(const CompressedVolume& volume, const Lighting& lighting, int threads) {
    const ClusteredTransfer& transfer = volume.compressed.transfer;
    const ClusterLighting relighter(transfer);
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(lighting, constants);
    std::vector<glm::vec3> incident(transfer.receivers.size() * transfer.bases.layout.outputs);
    evaluate(transfer, constants, incident, threads);
    return incident;
}

} // namespace prt
