// Numbers the unknowns of a mesh and creates the equations of its samples.

#include "bake/surface_fit/fit_equations.h"

#include <algorithm>

namespace prt {
namespace {

/// Assigns one unknown to equivalent receivers, numbered in the order of the mesh. The first of them may be
/// on no surface if it has only degenerate triangles.
void number_unknowns(const Receivers& receivers, std::span<const std::uint32_t> alike,
                     FitEquations& equations) {
    equations.unknown_of.assign(receivers.size(), kNoReceiver);
    std::vector<std::uint32_t> of_class(receivers.size(), kNoReceiver);
    for (const std::uint32_t p : receivers_on_surfaces(receivers)) {
        std::uint32_t& unknown = of_class[alike[p]];
        if (unknown == kNoReceiver)
            unknown = static_cast<std::uint32_t>(equations.unknowns++);
        equations.unknown_of[p] = unknown;
    }
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

/// Returns a triangle for each side whose corners are three different unknowns. Needles at the pole of a
/// sphere have only two, and their second difference is unbounded.
std::vector<FitTriangle> triangles_over(const Surfaces& surfaces, const TransportReceivers& receivers,
                                        std::span<const std::uint32_t> unknown_of) {
    std::vector<FitTriangle> triangles;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        for (const bool back : {false, true}) {
            FitTriangle triangle{unknowns_at(surfaces, receivers, unknown_of, t, back), {}};
            const auto& [a, b, c] = triangle.unknowns;
            if (std::ranges::count(triangle.unknowns, kNoReceiver) > 0 || a == b || b == c || c == a)
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
                           const SurfaceSamples& samples, std::span<const std::uint32_t> alike) {
    FitEquations equations;
    number_unknowns(receivers.receivers, alike, equations);
    equations.rows.reserve(samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const SamplePosition& position = samples.positions[s];
        equations.rows.push_back(
            {unknowns_at(surfaces, receivers, equations.unknown_of, position.triangle, position.back),
             position.shares(), samples.receivers.areas[s]});
    }
    equations.second_differences =
        second_differences_of(triangles_over(surfaces, receivers, equations.unknown_of));
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
