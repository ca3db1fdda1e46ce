// Spreads samples over triangles by area, with at least one on each triangle.

#include "bake/surface_fit/surface_samples.h"

#include "bake/scene/interpolated.h"
#include "bake/trace/sample_sequence.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Normal of a triangle's front, with twice its area as length.
glm::dvec3 doubled_area(const Receivers& receivers, const glm::uvec3& c) {
    const glm::dvec3 a(receivers.positions[c.x]), b(receivers.positions[c.y]), d(receivers.positions[c.z]);
    return glm::cross(b - a, d - a);
}

struct Sample {
    SamplePosition position;
    TriangleSide side;
    float area;
    std::uint32_t near; ///< receiver at the nearest corner
};

std::vector<Sample> spread_samples(const Surfaces& surfaces, const TransportReceivers& receivers,
                                   const SampleSpread& spread) {
    const std::vector<TriangleSide> sides = triangle_sides(surfaces, receivers, true);
    double area = 0;
    for (const TriangleSide& side : sides)
        area += side.area;
    // Samples in excess of one per side are distributed by area.
    const auto spare = static_cast<double>(spread.count - std::min(spread.count, sides.size()));
    const double per_area = area > 0 ? spare / area : 0;
    std::vector<Sample> samples;
    samples.reserve(spread.count);
    double owed = 0.5;
    for (const TriangleSide& side : sides) {
        owed += side.area * per_area;
        const double more = std::floor(owed);
        owed -= more;
        const auto n = static_cast<std::size_t>(more) + 1;
        const std::uint32_t hash = side_hash(side, spread.seed);
        const glm::uvec3 corners = corner_receivers(surfaces, receivers, side.triangle, side.back);
        for (std::size_t i = 0; i < n; ++i) {
            const SamplePosition position{side.triangle, side.back, even_point(hash, i)};
            const std::array<float, 3> shares = position.shares();
            const auto nearest = std::max_element(shares.begin(), shares.end()) - shares.begin();
            samples.push_back({position, side, static_cast<float>(side.area / static_cast<double>(n)),
                               corners[static_cast<int>(nearest)]});
        }
    }
    return samples;
}

/// Returns the interpolated normal, or the normal of the plane if the corners' normals cancel.
glm::vec3 normal_at(const Receivers& receivers, const glm::uvec3& corners, const SamplePosition& position,
                    const glm::vec3& of_plane) {
    glm::vec3 sum(0);
    const std::array<float, 3> shares = position.shares();
    for (int i = 0; i < 3; ++i)
        if (corners[i] != kNoReceiver)
            sum += shares[static_cast<std::size_t>(i)] * receivers.normals[corners[i]];
    const float length = glm::length(sum);
    return length > 0 ? sum / length : of_plane;
}

} // namespace

std::vector<TriangleSide> triangle_sides(const Surfaces& surfaces, const TransportReceivers& receivers,
                                         bool backs) {
    const Receivers& all = receivers.receivers;
    std::vector<TriangleSide> sides;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const double doubled = glm::length(doubled_area(all, surfaces.corners(t)));
        if (!(doubled > 0))
            continue;
        for (const bool back : {false, true}) {
            if (back && (!backs || receivers.back.empty() || !surfaces.two_sided(t)))
                continue;
            const glm::uvec3 corners = corner_receivers(surfaces, receivers, t, back);
            if (corners == glm::uvec3(kNoReceiver))
                continue;
            sides.push_back({t, back, 0.5 * doubled});
        }
    }
    return sides;
}

std::uint32_t side_hash(const TriangleSide& side, std::uint64_t seed) {
    return receiver_seed(2 * side.triangle + (side.back ? 1u : 0u), seed);
}

glm::vec2 even_point(std::uint32_t hash, std::size_t i) {
    // Powers of the inverse of the plastic number: the two-dimensional sequence with the lowest discrepancy
    // of its kind.
    constexpr double kPlastic = 1.32471795724474602596;
    const glm::dvec2 step(1 / kPlastic, 1 / (kPlastic * kPlastic));
    const glm::dvec2 offset((hash >> 16) / 65536.0, (hash & 0xffff) / 65536.0);
    const glm::dvec2 u = glm::fract(offset + static_cast<double>(i) * step);
    return glm::vec2(u.x + u.y > 1 ? 1.0 - u : u);
}

glm::uvec3 corner_receivers(const Surfaces& surfaces, const TransportReceivers& receivers,
                            std::uint32_t triangle, bool back) {
    glm::uvec3 corners = surfaces.corners(triangle);
    for (int i = 0; i < 3; ++i) {
        if (back)
            corners[i] = receivers.back_of(corners[i]);
        if (corners[i] != kNoReceiver && receivers.receivers.normals[corners[i]] == glm::vec3(0))
            corners[i] = kNoReceiver;
    }
    return corners;
}

std::vector<float> interpolated(const Transfer& transfer, const glm::uvec3& corners,
                                const SamplePosition& position) {
    const std::array<float, 3> shares = position.shares();
    std::vector<float> sum(transfer.dimension());
    for (std::size_t k = 0; k < sum.size(); ++k)
        sum[k] = shares[0] * transfer.vector(corners.x)[k] + shares[1] * transfer.vector(corners.y)[k] +
                 shares[2] * transfer.vector(corners.z)[k];
    return sum;
}

Receivers SurfaceSamples::layer(std::size_t k) const {
    Receivers result;
    for (std::size_t s = k; s < size(); s += layers)
        result.append(receivers, s);
    return result;
}

void append_sample(SurfaceSamples& samples, const Surfaces& surfaces, const TransportReceivers& receivers,
                   const SamplePosition& position, float area) {
    const Receivers& all = receivers.receivers;
    const glm::uvec3& c = surfaces.corners(position.triangle);
    const glm::dvec3 normal = doubled_area(all, c);
    const glm::vec3 of_plane((position.back ? -normal : normal) / glm::length(normal));
    samples.positions.push_back(position);
    Receivers& r = samples.receivers;
    r.positions.push_back(interpolated(all.positions, c, position.uv));
    r.normals.push_back(normal_at(
        all, corner_receivers(surfaces, receivers, position.triangle, position.back), position, of_plane));
    r.areas.push_back(area);
    r.starts.push_back(of_plane);
    if (receivers.detail)
        receivers.detail->move(r, r.size() - 1);
}

SurfaceSamples sample_surfaces(const Surfaces& surfaces, const TransportReceivers& receivers,
                               const SampleSpread& spread) {
    std::vector<Sample> all = spread_samples(surfaces, receivers, spread);
    std::stable_sort(all.begin(), all.end(),
                     [](const Sample& a, const Sample& b) { return a.near < b.near; });
    SurfaceSamples samples;
    samples.layers = spread.layers;
    for (const Sample& sample : all)
        append_sample(samples, surfaces, receivers, sample.position, sample.area);
    return samples;
}

} // namespace prt
