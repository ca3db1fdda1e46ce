// Combines hemisphere rays with connections to bright patches.

#include "bake/pipeline/lamp_rows.h"

#include "bake/scene/transmittance.h"
#include "bake/surface_fit/surface_samples.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/scrambles.h"
#include "shared_lamps.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// A receiver has one connection per kRaysPerConnection rays.
constexpr int kRaysPerConnection = 8;
/// Multiple of kSecondScramble, added to the seed; no other part of a bake uses it.
constexpr std::uint64_t kConnections = 20;
/// Form factor of a square metre with normal `there` at the end of `way`, for a receiver with normal `here`.
double form_factor(const glm::dvec3& way, const glm::dvec3& here, const glm::dvec3& there) {
    const double squared = glm::dot(way, way);
    if (!(squared > 0))
        return 0;
    return std::max(0.0, glm::dot(here, way)) * std::max(0.0, -glm::dot(there, way)) /
           (std::numbers::pi * squared * squared);
}

} // namespace

/// A receiver, and its number of samples of each technique.
struct LampConnections::Sampled {
    BrightPatches::Receiver receiver;
    double rays; ///< number of followed rays
    int connections;

    /// Expected samples per square metre.
    double density(double form_factor, double of_connections) const {
        return rays * form_factor + connections * of_connections;
    }
};

glm::dvec3 LampConnections::normal(std::uint32_t triangle, bool back) const {
    const auto [a, b, c] = patches_.corners(triangle);
    return glm::normalize(back ? glm::cross(c - a, b - a) : glm::cross(b - a, c - a));
}

std::vector<Hit> LampConnections::connect(const Sampled& sampled, const Start& start,
                                          const TraceOptions& options) const {
    const Surfaces& surfaces = plan_.scene.surfaces();
    const double shift = lamp_geometry::unit_number(start.seed);
    std::vector<Hit> hits;
    for (int i = 0; i < sampled.connections; ++i) {
        const glm::vec2 uv = even_point(start.seed * 2654435761u, static_cast<std::size_t>(i));
        const std::optional<BrightPatches::Point> point =
            patches_.pick(sampled.receiver, (i + shift) / sampled.connections, glm::dvec2(uv));
        if (!point)
            continue;
        const glm::dvec3 there = normal(point->triangle, point->back),
                         way = point->position - glm::dvec3(start.origin);
        const double factor = form_factor(way, sampled.receiver.normal, there);
        if (!(factor > 0))
            continue;
        const float open =
            arriving_from(plan_.scene.rays(), surfaces, start.origin, glm::vec3(way), point->triangle);
        if (open <= 0)
            continue;
        const double density = sampled.density(factor, point->density);
        hits.push_back(
            {.triangle = point->triangle,
             .u = uv.x,
             .v = uv.y,
             .weight = static_cast<float>(options.rays * static_cast<double>(open) * factor / density),
             .footprint = surfaces.traits().textured ? static_cast<float>(1 / density) : 0.0f,
             .back = point->back});
    }
    return hits;
}

/// Weight of a hemisphere ray's hit in combination with connections.
float LampConnections::share_of_rays(const Sampled& sampled, const Start& start, const Hit& hit) const {
    const double of_connections = patches_.density(sampled.receiver, hit.triangle, hit.back);
    if (!(of_connections > 0))
        return 1;
    const auto [a, b, c] = patches_.corners(hit.triangle);
    const glm::dvec3 position =
        a + static_cast<double>(hit.u) * (b - a) + static_cast<double>(hit.v) * (c - a);
    const double factor = form_factor(position - glm::dvec3(start.origin), sampled.receiver.normal,
                                      normal(hit.triangle, hit.back));
    return static_cast<float>(sampled.rays * factor / sampled.density(factor, of_connections));
}

LampConnections::Joined LampConnections::join(const Receivers& receivers, std::uint32_t p,
                                              std::span<const Hit> hits, const TraceOptions& options) const {
    const Start start{plan_.scene.rays().ray_origin(receivers, p),
                      receiver_seed(p, options.seed + options.first_ray + kConnections * kSecondScramble)};
    const int stride = plan_.scene.surfaces().traits().alpha ? 1 : options.hit_stride;
    const Sampled sampled{{glm::dvec3(start.origin), glm::dvec3(receivers.normals[p])},
                          static_cast<double>(options.rays) / stride,
                          patches_.empty() ? 0 : 2 * std::max(1, options.rays / (2 * kRaysPerConnection))};
    Joined joined;
    float all = 0, half = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        all += hits[i].weight;
        half += i % 2 == 1 ? hits[i].weight : 0.0f;
    }
    const auto add = [&joined](Hit hit, std::size_t i, float to_all) {
        joined.all.push_back(hit);
        hit.weight *= to_all;
        if (i % 2 == 1)
            joined.half.push_back(hit);
    };
    for (std::size_t i = 0; i < hits.size(); ++i) {
        Hit hit = hits[i];
        if (!patches_.empty())
            hit.weight *= share_of_rays(sampled, start, hit);
        add(hit, i, half > 0 ? all / half : 1.0f);
    }
    const std::vector<Hit> connected = connect(sampled, start, options);
    for (std::size_t i = 0; i < connected.size(); ++i)
        add(connected[i], i, 2);
    return joined;
}

std::optional<LampConnections> connections_to(const BakePlan& plan, LastOfLamps last, const Transfer& light) {
    if (last != LastOfLamps::connected || plan.detail || plan.lamps.empty() || plan.bounces == 0)
        return std::nullopt;
    return std::optional<LampConnections>(std::in_place, plan, light);
}

LampRows::LampRows(const BakePlan& plan, std::size_t rows, bool halves) : all(plan.gather_rows(rows)) {
    if (halves)
        half.emplace(plan.gather_rows(rows));
}

void LampRows::set(std::size_t row, const LampConnections::Joined& joined, int rays) {
    all.set_row(row, joined.all, rays);
    if (half)
        half->set_row(row, joined.half, rays);
}

} // namespace prt
