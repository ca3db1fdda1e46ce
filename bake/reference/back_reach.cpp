// Follows paths from the backs of triangles until they find light.

#include "bake/reference/back_reach.h"

#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace prt {
namespace {

constexpr int kReachBounces = 8;
constexpr float kReflected = 0.5f; ///< share of light that a surface reflects, independent of its color

/// All lamps at strength 1.
SceneLamps lit(const TraceScene& scene, std::span<const Lamp> lamps) {
    std::vector<TransferTerm> parts;
    for (const Lamp& lamp : lamps)
        parts.push_back({TermKind::lamp, 3, lamp.name, lamp.members});
    return {scene, parts, std::vector<glm::vec3>(parts.size(), glm::vec3(1))};
}

} // namespace

BackReach::BackReach(const TraceScene& scene, std::span<const Lamp> lamps, std::uint64_t seed)
    : scene_(scene), lamps_(lit(scene, lamps)), seed_(seed) {}

BackReach::Path BackReach::path(std::uint32_t triangle, std::uint32_t seed, std::uint32_t index,
                                std::span<const std::uint32_t> pieces) const {
    PathSamples samples(receiver_seed(seed, seed_), index);
    const glm::vec2 u = samples.next();
    const float root = std::sqrt(u.x);
    const SurfacePoint start{triangle, {root * (1 - u.y), root * u.y}, 0};
    LitSide side = met_surface(scene_.scene(), scene_.rays(), start, glm::vec3(0)).side.other();
    Path path;
    if (!(glm::dot(side.face, side.face) > 0))
        return path; // it has no area
    const Surfaces& surfaces = scene_.surfaces();
    // Light leaves a sheet from either side.
    const auto pass_sheet = [&](std::uint32_t at) {
        if (!surfaces.transmits(at) || samples.next().x < 0.5f)
            return;
        side = side.other();
        path.at_home = false;
    };
    pass_sheet(triangle);
    float weight = 1;
    for (int bounce = 0; bounce <= kReachBounces; ++bounce) {
        if (sees_lamp(side, samples))
            return {weight, false};
        const glm::vec3 along = cosine_direction(side.face, samples.next());
        const std::optional<SurfacePoint> met = nearest({side.origin(), along}, samples);
        if (!met)
            return {along.y > 0 ? weight : 0.0f, false};
        const MetSurface surface = met_surface(scene_.scene(), scene_.rays(), *met, along);
        if (lamps_.radiance(*met, surface.back) != glm::vec3(0))
            return {weight, false};
        path.at_home =
            path.at_home && surface.back && (pieces.empty() || pieces[met->triangle] == pieces[triangle]);
        if (surface.back && !surfaces.two_sided(met->triangle))
            return path;
        side = surface.side;
        pass_sheet(met->triangle);
        weight *= kReflected;
    }
    return path;
}

/// Tests one light and one point on emissive surfaces, both drawn by chance.
bool BackReach::sees_lamp(const LitSide& side, PathSamples& samples) const {
    const glm::vec3 origin = side.origin();
    const auto arrives = [&](const SceneLamps::Sample& sample) {
        return sample.irradiance != glm::vec3(0) && glm::dot(side.face, sample.towards) > 0 &&
               lamps_.open(origin, sample) > 0;
    };
    return (lamps_.has_lights() && arrives(lamps_.sample_light(origin, samples.next().x))) ||
           (lamps_.has_surfaces() && arrives(lamps_.sample_surface(origin, samples.next())));
}

/// Returns the hit that stops the ray; partial coverage stops it by chance.
std::optional<SurfacePoint> BackReach::nearest(Ray ray, PathSamples& samples) const {
    while (const std::optional<RayHit> met = scene_.rays().nearest(ray)) {
        const SurfacePoint point{met->triangle, met->uv, 0};
        if (samples.next().x < scene_.surfaces().coverage(point))
            return point;
        ray.from = std::nextafter(met->distance, std::numeric_limits<float>::infinity());
    }
    return std::nullopt;
}

std::vector<float> BackReach::means(std::span<const std::uint32_t> triangles) const {
    std::vector<float> means(triangles.size());
    parallel_for(triangles.size(), 64, scene_.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (const std::uint32_t index : {0u, 1u})
                means[i] += path(triangles[i], static_cast<std::uint32_t>(i), index).reach / 2;
    });
    return means;
}

} // namespace prt
