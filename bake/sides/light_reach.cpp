#include "sides/light_reach.h"

#include "pictures/light_paths.h"
#include "prt/scene_lamps.h"
#include "prt/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace prt {
namespace {

constexpr std::uint32_t kPaths = 2; ///< of a side
constexpr int kBounces = 8;
constexpr float kReflected = 0.5f; ///< of what reaches a surface, whatever its color

/// All of them at strength 1.
SceneLamps lit(const TraceScene& scene, std::span<const Lamp> lamps) {
    std::vector<TransferPart> parts;
    for (const Lamp& lamp : lamps)
        parts.push_back({PartKind::lamp, 3, lamp.name, lamp.members});
    return {scene, parts, std::vector<glm::vec3>(parts.size(), glm::vec3(1))};
}

class ReachTracer {
public:
    ReachTracer(const TraceScene& scene, const ReachOptions& options)
        : scene_(scene), lamps_(lit(scene, options.lamps)), seed_(options.seed) {}

    /// `sample` numbers the paths.
    float mean(std::uint32_t triangle, Side side, std::uint32_t sample) const {
        const std::uint32_t seed = receiver_seed(2 * sample + (side == Side::back), seed_);
        float sum = 0;
        for (std::uint32_t i = 0; i < kPaths; ++i) {
            PathSamples samples(seed, i);
            const glm::vec2 u = samples.next();
            const float root = std::sqrt(u.x);
            const SurfacePoint start{triangle, {root * (1 - u.y), root * u.y}, 0};
            const LitSide front = met_surface(scene_.scene(), scene_.rays(), start, glm::vec3(0)).side;
            if (!(glm::dot(front.face, front.face) > 0))
                return 0; // it has no area
            sum += follow(side == Side::front ? front : front.other(), samples);
        }
        return sum / kPaths;
    }

private:
    float follow(LitSide side, PathSamples samples) const {
        float weight = 1;
        for (int bounce = 0; bounce <= kBounces; ++bounce) {
            if (sees_lamp(side, samples))
                return weight;
            const glm::vec3 along = cosine_direction(side.face, samples.next());
            const std::optional<SurfacePoint> met = nearest({side.origin(), along}, samples);
            if (!met)
                return along.y > 0 ? weight : 0.0f;
            const MetSurface surface = met_surface(scene_.scene(), scene_.rays(), *met, along);
            if (lamps_.radiance(*met, surface.back) != glm::vec3(0))
                return weight;
            if (surface.back && !scene_.surfaces().two_sided(met->triangle))
                return 0;
            side = surface.side;
            weight *= kReflected;
        }
        return 0;
    }

    /// By one light and one point of what shines.
    bool sees_lamp(const LitSide& side, PathSamples& samples) const {
        const glm::vec3 origin = side.origin();
        const auto arrives = [&](const SceneLamps::Sample& sample) {
            return sample.irradiance != glm::vec3(0) && glm::dot(side.face, sample.towards) > 0 &&
                   lamps_.open(origin, sample) > 0;
        };
        return (lamps_.has_lights() && arrives(lamps_.sample_light(origin, samples.next().x))) ||
               (lamps_.has_surfaces() && arrives(lamps_.sample_surface(origin, samples.next())));
    }

    /// What stops the ray, by chance where it covers in part.
    std::optional<SurfacePoint> nearest(Ray ray, PathSamples& samples) const {
        while (const std::optional<RayHit> met = scene_.rays().nearest(ray)) {
            const SurfacePoint point{met->triangle, met->uv, 0};
            if (samples.next().x < scene_.surfaces().coverage(point))
                return point;
            ray.from = std::nextafter(met->distance, std::numeric_limits<float>::infinity());
        }
        return std::nullopt;
    }

    const TraceScene& scene_;
    SceneLamps lamps_;
    std::uint64_t seed_;
};

} // namespace

std::vector<float> light_reach(const TraceScene& scene, std::span<const std::uint32_t> triangles, Side side,
                               const ReachOptions& options, const std::stop_token& stop) {
    const ReachTracer tracer(scene, options);
    std::vector<float> reach(triangles.size());
    parallel_for(triangles.size(), 256, scene.threads(), [&](std::size_t begin, std::size_t end) {
        if (stop.stop_requested())
            throw Cancelled();
        for (std::size_t i = begin; i < end; ++i)
            reach[i] = tracer.mean(triangles[i], side, static_cast<std::uint32_t>(i));
    });
    return reach;
}

} // namespace prt
