// Compares the slopes of adjacent triangles, unfolded along their shared edge.

#include "bake/surface_fit/smoothness.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Maximum distance of a foot from an edge, in lengths of the edge: corners are floats with seven digits, so
/// that a larger distance is rounding. The resulting factors must be floats.
constexpr double kFarthestFoot = 1e18;

/// An edge of a triangle with the slope of the triangle.
struct Slope {
    std::uint32_t low, high; ///< unknowns at the ends of the edge
    std::uint32_t opposite;  ///< unknown at the opposite corner
    double share;            ///< share of `high` at the foot of that corner on the edge
    double height, area;
};

Slope slope_of(const FitTriangle& t, std::size_t edge) {
    std::size_t a = edge, b = (edge + 1) % 3;
    const std::size_t c = (edge + 2) % 3;
    if (t.unknowns[a] > t.unknowns[b])
        std::swap(a, b);
    const glm::dvec3 along = t.corners[b] - t.corners[a], up = t.corners[c] - t.corners[a];
    const double squared = glm::dot(along, along), doubled = glm::length(glm::cross(along, up));
    return {t.unknowns[a],
            t.unknowns[b],
            t.unknowns[c],
            squared > 0 ? glm::dot(up, along) / squared : 0,
            squared > 0 ? doubled / std::sqrt(squared) : 0,
            0.5 * doubled};
}

} // namespace

std::vector<SecondDifference> second_differences_of(std::span<const FitTriangle> triangles) {
    std::vector<Slope> slopes;
    slopes.reserve(3 * triangles.size());
    for (const FitTriangle& t : triangles)
        for (std::size_t edge = 0; edge < 3; ++edge)
            slopes.push_back(slope_of(t, edge));
    const auto ends = [](const Slope& s) { return std::pair(s.low, s.high); };
    std::stable_sort(slopes.begin(), slopes.end(),
                     [&](const Slope& a, const Slope& b) { return ends(a) < ends(b); });
    std::vector<SecondDifference> second_differences;
    for (std::size_t begin = 0, end = 0; begin < slopes.size(); begin = end) {
        while (end < slopes.size() && ends(slopes[end]) == ends(slopes[begin]))
            ++end;
        const Slope &a = slopes[begin], &b = slopes[end - 1];
        if (end != begin + 2 || a.low == a.high || a.opposite == b.opposite || !(a.height > 0) ||
            !(b.height > 0) || std::max(std::abs(a.share), std::abs(b.share)) > kFarthestFoot)
            continue;
        const double h = 2 * a.height * b.height / (a.height + b.height);
        const double to_a = h / a.height, to_b = h / b.height;
        second_differences.push_back({{a.opposite, b.opposite, a.low, a.high},
                                      {static_cast<float>(to_a), static_cast<float>(to_b),
                                       static_cast<float>(-to_a * (1 - a.share) - to_b * (1 - b.share)),
                                       static_cast<float>(-to_a * a.share - to_b * b.share)},
                                      static_cast<float>(a.area + b.area)});
    }
    return second_differences;
}

} // namespace prt
