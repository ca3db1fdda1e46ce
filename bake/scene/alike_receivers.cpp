// Finds vertices that were duplicated for texture coordinates or materials.

#include "bake/scene/alike_receivers.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

/// Tolerance for equal normals: normals of one plane differ by rounding, in files and after computation.
constexpr float kSameNormal = 1e-4f;
/// Tolerance for equal positions, relative to the largest coordinate; positions at the pole of a sphere
/// differ by 1e-16.
constexpr float kSamePosition = 1e-7f;

struct Position {
    std::tuple<int, bool, float, float, float> key; ///< node, side and position
    std::uint32_t receiver;
};

/// Node of each receiver at a corner, [receivers]; -1: the receiver is at no corner.
std::vector<int> nodes_of(const Surfaces& surfaces, std::size_t receivers,
                          std::span<const std::uint32_t> back) {
    std::vector<int> nodes(receivers, -1);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const int node = surfaces.scene().primitives[surfaces.primitive(t)].node;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            nodes[front] = node;
            if (!back.empty() && back[front] < receivers)
                nodes[back[front]] = node;
        }
    }
    return nodes;
}

} // namespace

std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces, const Receivers& receivers,
                                           std::size_t fronts, std::span<const std::uint32_t> back) {
    const std::vector<int> nodes = nodes_of(surfaces, receivers.size(), back);
    float largest = 0;
    for (const glm::vec3& at : receivers.positions)
        largest = std::max({largest, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
    const float cell = std::max(kSamePosition * largest, std::numeric_limits<float>::min());
    std::vector<Position> points;
    std::vector<std::uint32_t> first(receivers.size());
    std::iota(first.begin(), first.end(), 0u);
    for (std::uint32_t p = 0; p < receivers.size(); ++p)
        if (nodes[p] >= 0) {
            const glm::vec3 at = glm::round(receivers.positions[p] / cell);
            points.push_back({{nodes[p], p >= fronts, at.x, at.y, at.z}, p});
        }
    std::ranges::sort(points, [](const Position& a, const Position& b) {
        return a.key != b.key ? a.key < b.key : a.receiver < b.receiver;
    });
    std::vector<std::uint32_t> here; // first receiver of each normal at one position
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t p = points[i].receiver;
        if (i == 0 || points[i].key != points[i - 1].key)
            here.clear();
        const auto found = std::ranges::find_if(here, [&](std::uint32_t q) {
            return glm::distance(receivers.normals[p], receivers.normals[q]) <= kSameNormal;
        });
        if (found == here.end())
            here.push_back(p);
        else
            first[p] = *found;
    }
    return first;
}

} // namespace prt
