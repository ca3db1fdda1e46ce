// Rays through voxels.

#include "far/blocker_volume.h"

#include "prt/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace prt {
namespace {

/// Depths beyond leave nothing.
constexpr float kDeepest = 9.0f; // e^-9 = 1.2e-4

} // namespace

void Extinction::add(const glm::vec3& normal, float area) {
    // |cos| by bands 0 and 2: 1/2 + 5/8 P2(cos) = 3/16 + 15/16 cos².
    squares += area * (3.0f / 16 + 15.0f / 16 * normal * normal);
    products += area * 15.0f / 8 * glm::vec3(normal.y * normal.z, normal.z * normal.x, normal.x * normal.y);
}

BlockerVolume::BlockerVolume(const TraceScene& scene, const DenseParts& dense, float size) {
    if (dense.triangles == 0)
        return;
    grid_ = CellGrid(dense.all.low, dense.all.high, size);
    add_pieces(scene, dense);
    hits_.resize(grid_.cells() * kHits);
    kept_.resize(grid_.cells());
    parallel_for(grid_.cells(), 64, scene.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            fit(scene, dense, static_cast<std::uint32_t>(cell));
    });
    const float scale = fit_nodes(scene, dense);
    for (Extinction& extinction : extinctions_)
        extinction.scale(scale);
}

std::size_t BlockerVolume::bytes() const {
    return extinctions_.size() * sizeof(Extinction) + hits_.size() * sizeof(VoxelHit) + grid_.bytes();
}

float BlockerVolume::depth(const glm::vec3& origin, const glm::vec3& direction, float from, float to,
                           float most) const {
    float depth = 0;
    grid_.walk(origin, direction, from, to, [&](std::uint32_t cell, float begin, float end) {
        depth += extinctions_[cell].along(direction) * (end - begin);
        return depth < most;
    });
    return depth;
}

float BlockerVolume::passes(const glm::vec3& origin, const glm::vec3& direction, float from, float to) const {
    if (grid_.cells() == 0)
        return 1;
    const float all = depth(origin, direction, from, to, kDeepest);
    return all < kDeepest ? std::exp(-all) : 0.0f;
}

BlockerVolume::Met BlockerVolume::end_of(const glm::vec3& origin, const glm::vec3& direction, float from,
                                         float stopped, float random) const {
    const float until = -std::log1p(-random * stopped);
    float depth = 0, way = from;
    std::uint32_t last = 0;
    grid_.walk(origin, direction, from, std::numeric_limits<float>::infinity(),
               [&](std::uint32_t cell, float begin, float end) {
                   if (kept_[cell] == 0)
                       return true;
                   last = cell;
                   way = 0.5f * (begin + end) * grid_.size();
                   depth += extinctions_[cell].along(direction) * (end - begin);
                   return depth < until;
               });
    // A number of its own: the rest of the one that chose the depth.
    const float rest = random * 4096;
    return {choose(last, direction, rest - std::floor(rest)), way};
}

/// One of the hits that rays of like directions met.
const VoxelHit& BlockerVolume::choose(std::uint32_t cell, const glm::vec3& direction, float random) const {
    const auto hits = std::span(hits_).subspan(std::size_t{cell} * kHits, kept_[cell]);
    const auto weight = [&](const VoxelHit& hit) {
        const float along = std::max(0.0f, glm::dot(hit.direction, direction));
        return along * along + 1e-4f; // one of the others, where none is alike
    };
    float all = 0;
    for (const VoxelHit& hit : hits)
        all += weight(hit);
    float left = random * all;
    for (const VoxelHit& hit : hits)
        if ((left -= weight(hit)) < 0)
            return hit;
    return hits.back();
}

} // namespace prt
