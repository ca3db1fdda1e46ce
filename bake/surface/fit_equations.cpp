// Numbers the unknowns of a mesh and writes down what samples are of them.

#include "surface/fit_equations.h"

#include <algorithm>
#include <tuple>

namespace prt {
namespace {

/// Gives receivers that are alike one unknown, numbered in the order of the mesh.
void number_unknowns(const TransportReceivers& receivers, FitEquations& equations) {
    const Receivers& all = receivers.receivers;
    const auto key = [&](std::uint32_t p) {
        const glm::vec3 &at = all.positions[p], &n = all.normals[p];
        return std::tuple(p >= receivers.fronts, at.x, at.y, at.z, n.x, n.y, n.z);
    };
    std::vector<std::uint32_t> order = receivers_on_surfaces(all);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<std::uint32_t> first(all.size(), kNoReceiver); // of those that are alike
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    equations.unknown_of.assign(all.size(), kNoReceiver);
    for (std::uint32_t p = 0; p < all.size(); ++p)
        if (first[p] != kNoReceiver)
            equations.unknown_of[p] = first[p] == p ? static_cast<std::uint32_t>(equations.unknowns++)
                                                    : equations.unknown_of[first[p]];
}

std::array<std::uint32_t, 3> unknowns_at(const Surfaces& surfaces, const TransportReceivers& receivers,
                                         std::span<const std::uint32_t> unknown_of, std::uint32_t triangle,
                                         bool back) {
    const glm::uvec3 corners = corner_receivers(surfaces, receivers, triangle, back);
    std::array<std::uint32_t, 3> unknowns;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t corner = corners[static_cast<int>(i)];
        unknowns[i] = corner == kNoReceiver ? kNoReceiver : unknown_of[corner];
    }
    return unknowns;
}

/// One for each side of a triangle, where all corners are unknowns.
std::vector<FitTriangle> triangles_over(const Surfaces& surfaces, const TransportReceivers& receivers,
                                        std::span<const std::uint32_t> unknown_of) {
    std::vector<FitTriangle> triangles;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        for (const bool back : {false, true}) {
            FitTriangle triangle{unknowns_at(surfaces, receivers, unknown_of, t, back), {}};
            if (std::ranges::count(triangle.unknowns, kNoReceiver) > 0)
                continue;
            for (std::size_t i = 0; i < 3; ++i)
                triangle.corners[i] =
                    glm::dvec3(receivers.receivers.positions[surfaces.corners(t)[static_cast<int>(i)]]);
            triangles.push_back(triangle);
        }
    return triangles;
}

} // namespace

FitEquations fit_equations(const Surfaces& surfaces, const TransportReceivers& receivers,
                           const SurfaceSamples& samples) {
    FitEquations equations;
    number_unknowns(receivers, equations);
    equations.rows.reserve(samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const SamplePlace& place = samples.places[s];
        equations.rows.push_back(
            {unknowns_at(surfaces, receivers, equations.unknown_of, place.triangle, place.back),
             place.shares(), samples.receivers.areas[s]});
    }
    equations.bends = bends_of(triangles_over(surfaces, receivers, equations.unknown_of));
    return equations;
}

SumRow sum_row(const FitRow& row) {
    static_assert(kNoReceiver == kNoSum);
    return {row.unknowns, {row.area * row.shares[0], row.area * row.shares[1], row.area * row.shares[2]}};
}

std::vector<float> unknown_weights(const FitEquations& equations) {
    std::vector<float> weights(equations.unknowns);
    for (const FitRow& row : equations.rows)
        for (std::size_t i = 0; i < row.unknowns.size(); ++i)
            if (row.unknowns[i] != kNoReceiver)
                weights[row.unknowns[i]] += row.area * row.shares[i];
    return weights;
}

} // namespace prt
