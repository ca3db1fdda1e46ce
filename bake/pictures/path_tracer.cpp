// Path tracing: next-event estimation and cosine sampling, combined by the balance heuristic (E. Veach,
// "Robust Monte Carlo Methods for Light Transport Simulation", 1997).

#include "prt/path_tracer.h"

#include "pictures/lit_side.h"
#include "prt/support/parallel.h"
#include "prt/support/tangent_frame.h"
#include "scene/transmittance.h"
#include "trace/sample_sequence.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace prt {
namespace {

constexpr float kFarAway = std::numeric_limits<float>::infinity();
constexpr float kPi = std::numbers::pi_v<float>;
/// Paths are ended at random from this vertex on, where their number is not bounded.
constexpr int kFirstRoulette = 4;

/// The points of one path. Every pair of dimensions is a Sobol net over the passes, scrambled and put in an
/// order of its own (B. Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
class PathSamples {
public:
    PathSamples(std::uint32_t seed, std::uint32_t index) : seed_(seed), reversed_(reverse_bits(index)) {}

    glm::vec2 next() {
        const std::uint32_t hash = pcg_hash(seed_ + 3 * ++pair_);
        const SobolOffset point = sobol_offset(reverse_bits(laine_karras(reversed_, hash)));
        return {unit(laine_karras(point.x, pcg_hash(hash + 1))),
                unit(laine_karras(point.y, pcg_hash(hash + 2)))};
    }

private:
    static float unit(std::uint32_t reversed) {
        return static_cast<float>(reverse_bits(reversed) >> 8) * 0x1p-24f;
    }
    std::uint32_t seed_, reversed_, pair_ = 0;
};

glm::vec3 cosine_direction(const glm::vec3& normal, const glm::vec2& u) {
    const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
    const TangentFrame frame = tangent_frame(normal);
    return frame.tangent * (radius * std::cos(angle)) + frame.bitangent * (radius * std::sin(angle)) +
           frame.normal * std::sqrt(std::max(0.0f, 1 - u.x));
}

float largest(const glm::vec3& v) {
    return std::max({v.r, v.g, v.b});
}

struct SurfaceHit {
    float distance;
    SurfacePoint point;
    LitSide side;  ///< that was met
    bool scatters; ///< that side of it
};

struct Path {
    Ray ray; ///< that comes next
    glm::vec3 radiance{0}, throughput{1};
    std::optional<float> density = {}; ///< of the ray's direction by the cosine; none: the camera's own ray
    int vertices = 0;

    bool from_camera() const { return !density; }
};

/// What all paths of a picture share.
struct Tracing {
    const RayScene& rays;
    const Scene& scene;
    const Surfaces& surfaces;
    const DistantLight& light;
    const PathTraceOptions& options;

    std::optional<SurfaceHit> nearest(const Ray& ray) const;
    void add_background(Path& path) const;
    /// One of the two sides, by how much it scatters; none where neither does.
    std::optional<LitSide> choose_side(const SurfaceHit& hit, Path& path, PathSamples& samples) const;
    void add_direct_light(const LitSide& side, Path& path, PathSamples& samples) const;
    /// Goes on in a direction by the cosine; false where the path ends.
    bool scatter(const LitSide& side, Path& path, PathSamples& samples) const;
    /// That a path through the ray of the camera brings.
    glm::vec3 radiance(const Ray& camera_ray, PathSamples& samples) const;
};

std::optional<SurfaceHit> Tracing::nearest(const Ray& ray) const {
    const std::optional<RayHit> met = rays.nearest(ray);
    if (!met)
        return std::nullopt;
    const SurfacePoint point{met->triangle, met->uv, 0};
    const MetSurface surface =
        met_surface(scene, rays, point, ray.origin + ray.direction * met->distance, ray.direction);
    return SurfaceHit{met->distance, point, surface.side, !surface.back || surfaces.two_sided(met->triangle)};
}

void Tracing::add_background(Path& path) const {
    if (path.from_camera() && !options.background)
        return;
    const float light_density = path.from_camera() ? 0.0f : light.density(path.ray.direction);
    const float weight = path.from_camera() ? 1.0f : *path.density / (*path.density + light_density);
    path.radiance += path.throughput * light.radiance(path.ray.direction) * weight;
}

std::optional<LitSide> Tracing::choose_side(const SurfaceHit& hit, Path& path, PathSamples& samples) const {
    const Scattering scattering = path.from_camera() ? seen_scattering(surfaces, hit.point, options.textured)
                                                     : surfaces.scattering(hit.point);
    const float reflected = largest(scattering.reflected), transmitted = largest(scattering.transmitted);
    if (!(reflected + transmitted > 0))
        return std::nullopt;
    const bool through = samples.next().x * (reflected + transmitted) >= reflected;
    const float share = (through ? transmitted : reflected) / (reflected + transmitted);
    path.throughput *= (through ? scattering.transmitted : scattering.reflected) / share;
    return through ? hit.side.other() : hit.side;
}

void Tracing::add_direct_light(const LitSide& side, Path& path, PathSamples& samples) const {
    for (const Sun& sun : light.suns())
        if (side.faces(sun.towards))
            path.radiance += path.throughput * sun.irradiance * glm::dot(side.normal, sun.towards) / kPi *
                             transmittance(rays, surfaces, side.origin(), sun.towards);
    const DistantLight::Sample sample = light.sample(samples.next());
    if (sample.density > 0 && side.faces(sample.direction)) {
        const float cosine = glm::dot(side.normal, sample.direction) / kPi;
        path.radiance += path.throughput * sample.radiance * (cosine / (sample.density + cosine)) *
                         transmittance(rays, surfaces, side.origin(), sample.direction);
    }
}

bool Tracing::scatter(const LitSide& side, Path& path, PathSamples& samples) const {
    const glm::vec3 direction = cosine_direction(side.normal, samples.next());
    if (!side.faces(direction)) // below the facet, though above the interpolated normal
        return false;
    path.density = glm::dot(side.normal, direction) / kPi;
    path.ray = {side.origin(), direction};
    if (++path.vertices < kFirstRoulette || options.bounces >= 0)
        return true;
    const float survival = std::min(0.98f, largest(path.throughput));
    if (samples.next().x >= survival)
        return false;
    path.throughput /= survival;
    return true;
}

glm::vec3 Tracing::radiance(const Ray& camera_ray, PathSamples& samples) const {
    Path path{camera_ray};
    for (;;) {
        const std::optional<SurfaceHit> hit = nearest(path.ray);
        if (!hit) {
            add_background(path);
            return path.radiance;
        }
        // The camera looks through back sides, as pictures do; light does not pass them.
        if ((path.from_camera() && !hit->scatters) || samples.next().x >= surfaces.coverage(hit->point)) {
            path.ray.from = std::nextafter(hit->distance, kFarAway);
            continue;
        }
        if (!hit->scatters || (options.bounces >= 0 && path.vertices > options.bounces))
            return path.radiance;
        const std::optional<LitSide> side = choose_side(*hit, path, samples);
        if (!side)
            return path.radiance;
        add_direct_light(*side, path, samples);
        if (!scatter(*side, path, samples))
            return path.radiance;
    }
}

glm::vec3 unit_direction(const CameraFrame& frame, const PathTraceOptions& options, double x, double y) {
    return glm::vec3(glm::normalize(view_direction(frame, options.width, options.height, x, y)));
}

} // namespace

PathTracer::PathTracer(const TraceScene& scene, const DistantLight& light, const PathTraceOptions& options)
    : scene_(scene), light_(light), options_(options), frame_(camera_frame(options.camera)),
      sums_(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height)),
      counts_(static_cast<std::size_t>(options.height)) {}

void PathTracer::add_pass(int threads, std::stop_token stop) {
    const Tracing tracing{scene_.rays(), scene_.scene(), scene_.surfaces(), light_, options_};
    const auto pass = static_cast<std::uint32_t>(passes_);
    parallel_for(counts_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            if (stop.stop_requested())
                throw Cancelled();
            for (int x = 0; x < options_.width; ++x) {
                const std::size_t i =
                    y * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
                PathSamples samples(receiver_seed(static_cast<std::uint32_t>(i), options_.seed), pass);
                const glm::dvec2 at = options_.antialiased ? glm::dvec2(samples.next()) : glm::dvec2(0.5);
                const glm::vec3 view =
                    unit_direction(frame_, options_, x + at.x, static_cast<double>(y) + at.y);
                sums_[i] += tracing.radiance({options_.camera.position, view}, samples);
            }
            ++counts_[y];
        }
    });
    ++passes_;
}

Image PathTracer::image() const {
    Image image{options_.width, options_.height, sums_};
    for (int y = 0; y < options_.height; ++y)
        for (int x = 0; x < options_.width; ++x)
            image.at(x, y) /= static_cast<float>(std::max(1, counts_[static_cast<std::size_t>(y)]));
    return image;
}

std::vector<bool> PathTracer::surface_mask() const {
    const Tracing tracing{scene_.rays(), scene_.scene(), scene_.surfaces(), light_, options_};
    std::vector<bool> mask;
    for (int y = 0; y < options_.height; ++y)
        for (int x = 0; x < options_.width; ++x) {
            Ray ray{options_.camera.position, unit_direction(frame_, options_, x + 0.5, y + 0.5)};
            auto hit = tracing.nearest(ray);
            while (hit && (!hit->scatters || scene_.surfaces().coverage(hit->point) < 0.5f)) {
                ray.from = std::nextafter(hit->distance, kFarAway);
                hit = tracing.nearest(ray);
            }
            mask.push_back(hit.has_value());
        }
    return mask;
}

} // namespace prt
