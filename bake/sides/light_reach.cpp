#include "sides/light_reach.h"

#include "lamps/punctual.h"
#include "pictures/light_paths.h"
#include "prt/bake.h"
#include "prt/support/parallel.h"
#include "scene/transmittance.h"

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

class ReachTracer {
public:
    ReachTracer(const TraceScene& scene, const ReachOptions& options) : scene_(scene), options_(options) {}

    /// `sample` numbers the paths.
    float mean(std::uint32_t triangle, Side side, std::uint32_t sample) const {
        const std::uint32_t seed = receiver_seed(2 * sample + (side == Side::back), options_.seed);
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
            if (options_.lamps && sees_lights(side))
                return weight;
            const glm::vec3 along = cosine_direction(side.face, samples.next());
            const std::optional<SurfacePoint> met = nearest({side.origin(), along}, samples);
            if (!met)
                return along.y > 0 ? weight : 0.0f;
            const MetSurface surface = met_surface(scene_.scene(), scene_.rays(), *met, along);
            const bool scatters = !surface.back || scene_.surfaces().two_sided(met->triangle);
            if (options_.lamps && scatters && scene_.surfaces().emits(met->triangle))
                return weight;
            if (!scatters)
                return 0;
            side = surface.side;
            weight *= kReflected;
        }
        return 0;
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

    bool sees_lights(const LitSide& side) const {
        return std::ranges::any_of(scene_.scene().lights, [&](const PunctualLight& light) {
            const bool far = light.kind == PunctualKind::directional;
            const glm::vec3 origin = side.origin(), way = far ? -light.direction : light.position - origin;
            const float distance = glm::length(way);
            if (!(distance > 0) || !(glm::dot(side.face, way) > 0) || light.intensity == glm::vec3(0))
                return false;
            const glm::vec3 towards = way / distance;
            if (!far && !(cone_share(light, glm::dvec3(-towards)) > 0 &&
                          range_share(light, static_cast<double>(distance)) > 0))
                return false;
            const float to = far ? std::numeric_limits<float>::infinity() : distance;
            return transmittance(scene_.rays(), scene_.surfaces(), origin, towards, to) > 0;
        });
    }

    const TraceScene& scene_;
    const ReachOptions& options_;
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
