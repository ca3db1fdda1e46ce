// Traces paths from positions in free space, in directions uniform over the sphere.

#include "bake/reference/incident_reference.h"

#include "bake/reference/light_paths.h"
#include "bake/scene/transmittance.h"
#include "bake/trace/each_receiver.h"
#include "bake/trace/sample_sequence.h"
#include "prt/bake/bake_options.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace prt {
namespace {

constexpr float kMaxBackShare = 0.25f;
/// Density of the first ray, which unlike a camera ray does not pass back sides of surfaces.
constexpr float kEven = 1 / (4 * std::numbers::pi_v<float>);

glm::vec3 direction_of(const glm::vec2& u) {
    const float z = 1 - 2 * u.x, radius = std::sqrt(std::max(0.0f, 1 - z * z)),
                angle = 2 * std::numbers::pi_v<float> * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Coefficients of incident light, summed direction by direction.
struct IncidentSum {
    int order;
    std::span<glm::vec3> coefficients;

    void add(const glm::vec3& from, const glm::vec3& irradiance) {
        std::array<float, kMaxIncidentOrder * kMaxIncidentOrder> basis{};
        evaluate_sh(order, from, std::span(basis).first(coefficients.size()));
        for (std::size_t o = 0; o < coefficients.size(); ++o)
            coefficients[o] += basis[o] * irradiance;
    }
};

/// Adds direct light of lamps at `position`. Lamps that rays can also hit are weighted by the share of their
/// samples.
void add_lamps(const SceneLamps& lamps, const glm::vec3& position, PathSamples& samples, float weight,
               IncidentSum& sum) {
    const auto add = [&](const SceneLamps::Sample& sample) {
        if (sample.irradiance != glm::vec3(0))
            sum.add(sample.towards,
                    weight * sample.balance(kEven) * lamps.open(position, sample) * sample.irradiance);
    };
    if (lamps.has_lights())
        add(lamps.sample_light(position, samples.next().x));
    if (lamps.has_surfaces())
        add(lamps.sample_surface(position, samples.next()));
}

struct Surroundings {
    float distance = std::numeric_limits<float>::infinity(); ///< distance to the nearest surface, metres
    bool shut = true;                                        ///< no light of the sky arrives
};

/// Returns nothing if `position` is inside geometry.
std::optional<Surroundings> surroundings_of(const TraceScene& scene, const glm::vec3& position) {
    constexpr int kDirections = 256;
    Surroundings around;
    int backs = 0;
    for (int i = 0; i < kDirections; ++i) {
        const float rotation = 0.6180339887f * static_cast<float>(i);
        const glm::vec3 d =
            direction_of({(static_cast<float>(i) + 0.5f) / kDirections, rotation - std::floor(rotation)});
        const auto hit = scene.rays().nearest({position, d});
        around.shut = around.shut && transmittance(scene.rays(), scene.surfaces(), position, d) <= 0;
        if (!hit)
            continue;
        const MetSurface met = met_surface(scene.scene(), scene.rays(), {hit->triangle, hit->uv, 0}, d);
        around.distance = std::min(around.distance, hit->distance * std::abs(glm::dot(met.side.face, d)));
        backs += met.back && !scene.surfaces().two_sided(hit->triangle);
    }
    if (static_cast<float>(backs) > kMaxBackShare * kDirections)
        return std::nullopt;
    return around;
}

} // namespace

FreePositions free_positions_in(const TraceScene& scene, const VolumeGrid& grid, std::size_t count,
                                std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const glm::vec3 extent = grid.spacing * static_cast<float>(kBrickCells) * glm::vec3(grid.size);
    auto [low, high] = bounds(scene.scene());
    low = glm::max(low, grid.origin);
    high = glm::min(high, grid.origin + extent);
    FreePositions points;
    for (std::size_t tries = 0; points.positions.size() < count; ++tries) {
        if (tries > 20 * count)
            throw Error("the volume has almost no free space for test points");
        const float x = unit(random), y = unit(random), z = unit(random);
        const glm::vec3 position = low + (high - low) * glm::vec3(x, y, z);
        if (const auto around = surroundings_of(scene, position)) {
            points.positions.push_back(position);
            points.distances.push_back(around->distance);
            points.shut.push_back(around->shut);
        }
    }
    return points;
}

std::array<std::vector<glm::vec3>, 2>
incident_reference(const TraceScene& scene, const std::vector<glm::vec3>& points, int order,
                   const ReferenceLight& light, const IncidentOptions& options, const Progress& progress) {
    // A visible surface is lit by all light; only at the position itself the renderer adds a part of the
    // light.
    const LightPaths paths{scene, {light.all, light.all, options.lamps}, {kEndlessBounces, true, false}};
    const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
    const float weight = 4 * std::numbers::pi_v<float> / static_cast<float>(options.paths);
    std::array<std::vector<glm::vec3>, 2> halves;
    for (auto& half : halves)
        half.resize(points.size() * coefficients);
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    for_each_receiver(all, options.threads, progress, [&](std::uint32_t p) {
        for (std::size_t h = 0; h < halves.size(); ++h) {
            IncidentSum sum{order, std::span(halves[h]).subspan(p * coefficients, coefficients)};
            for (int i = 0; i < options.paths; ++i) {
                PathSamples samples(receiver_seed(2 * p + static_cast<std::uint32_t>(h), options.seed),
                                    static_cast<std::uint32_t>(i));
                const glm::vec3 d = direction_of(samples.next());
                if (options.lamps)
                    add_lamps(*options.lamps, points[p], samples, 1 / static_cast<float>(options.paths), sum);
                LightPath path{.ray = {points[p], d}, .density = kEven};
                const bool open = paths.follow(path, samples) && path.vertices == 0;
                const glm::vec3 radiance = open ? light.seen().radiance(d) : path.radiance;
                sum.add(d, weight * radiance);
            }
        }
    });
    return halves;
}

} // namespace prt
