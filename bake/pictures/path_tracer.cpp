#include "prt/path_tracer.h"

#include "scene/interpolated.h"
#include "trace/sample_sequence.h"

#include "prt/support/parallel.h"
#include "prt/support/tangent_frame.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace prt {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
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
    unsigned id;
    float distance;
    SurfacePoint point;
    glm::vec3 position, face, normal; ///< unit, towards the side that was met
    bool back;
    bool scatters; ///< that side of it
};

/// What all paths of a picture share.
struct Tracing {
    const RayScene& rays;
    const Scene& scene;
    const Surfaces& surfaces;
    const DistantLight& light;
    const PathTraceOptions& options;

    std::optional<SurfaceHit> nearest(const glm::vec3& origin, const glm::vec3& direction, float from) const;
    /// Share of light that reaches `origin` from far away along `direction`.
    float transmittance(const glm::vec3& origin, const glm::vec3& direction) const;
    glm::vec3 origin_off(const SurfaceHit& hit, const glm::vec3& direction) const;
    glm::vec3 path(const glm::vec3& origin, const glm::vec3& direction, PathSamples& samples) const;
};

std::optional<SurfaceHit> Tracing::nearest(const glm::vec3& origin, const glm::vec3& direction,
                                           float from) const {
    const std::optional<RayHit> met = rays.nearest({origin, direction, from});
    if (!met)
        return std::nullopt;
    SurfaceHit hit;
    hit.id = met->triangle;
    hit.distance = met->distance;
    hit.point = {met->triangle, met->uv, 0};
    hit.position = origin + direction * met->distance;
    const RayScene::Triangle triangle = rays.triangle(hit.id);
    const Primitive& primitive = scene.primitives[triangle.primitive];
    const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
    const glm::uvec3& t = primitive.triangles[triangle.triangle];
    hit.face = glm::cross(vertices.positions[t.y] - vertices.positions[t.x],
                          vertices.positions[t.z] - vertices.positions[t.x]);
    hit.back = glm::dot(hit.face, direction) > 0;
    hit.scatters = !hit.back || surfaces.two_sided(hit.id);
    glm::vec3 normal = interpolated(vertices.normals, t, hit.point.uv);
    hit.face = glm::normalize(hit.back ? -hit.face : hit.face);
    const float length = glm::length(normal);
    hit.normal = length > 0 ? (hit.back ? -normal : normal) / length : hit.face;
    return hit;
}

float Tracing::transmittance(const glm::vec3& origin, const glm::vec3& direction) const {
    Ray ray{origin, direction};
    if (!surfaces.traits().alpha)
        return rays.occluded(ray) ? 0.0f : 1.0f;
    float left = 1;
    while (left > 0) {
        const std::optional<RayHit> met = rays.nearest(ray);
        if (!met)
            break;
        left *= 1 - surfaces.coverage({met->triangle, met->uv, 0});
        ray.from = std::nextafter(met->distance, kInfinity);
    }
    return left;
}

glm::vec3 Tracing::origin_off(const SurfaceHit& hit, const glm::vec3& direction) const {
    const float side = glm::dot(hit.face, direction) >= 0 ? 1.0f : -1.0f;
    return hit.position + hit.face * (side * rays.triangle_offset(hit.id));
}

glm::vec3 Tracing::path(const glm::vec3& camera, const glm::vec3& view, PathSamples& samples) const {
    glm::vec3 radiance(0), throughput(1), origin = camera, direction = view;
    float from = 0;
    float cosine_density = 0; // of `direction`; 0: the camera's own ray
    int vertex = 0;
    for (;;) {
        const std::optional<SurfaceHit> hit = nearest(origin, direction, from);
        if (!hit) {
            const bool seen = cosine_density == 0;
            if (seen && !options.background)
                return radiance;
            const float light_density = seen ? 0.0f : light.density(direction);
            const float weight = seen ? 1.0f : cosine_density / (cosine_density + light_density);
            return radiance + throughput * light.radiance(direction) * weight;
        }
        const bool seen = cosine_density == 0;
        // The camera looks through back sides, as pictures do; light does not pass them.
        if ((seen && !hit->scatters) || samples.next().x >= surfaces.coverage(hit->point)) {
            from = std::nextafter(hit->distance, kInfinity);
            continue;
        }
        if (!hit->scatters || (options.bounces >= 0 && vertex > options.bounces))
            return radiance;
        Scattering scattering = surfaces.scattering(hit->point);
        if (seen && !surfaces.transmits(hit->id)) { // all of the base colour, as renderers multiply by it
            scattering = {options.textured ? surfaces.base_color(hit->point) : glm::vec3(1), glm::vec3(0)};
        } else if (seen && !options.textured) { // the share of the base colour that each side has
            const glm::vec3 base = glm::max(surfaces.base_color(hit->point), glm::vec3(1e-6f));
            scattering = {scattering.reflected / base, scattering.transmitted / base};
        }
        const float reflected = largest(scattering.reflected), transmitted = largest(scattering.transmitted);
        if (!(reflected + transmitted > 0))
            return radiance;
        // One of the two sides, by how much it scatters.
        const bool through = samples.next().x * (reflected + transmitted) >= reflected;
        const float share = (through ? transmitted : reflected) / (reflected + transmitted);
        throughput *= (through ? scattering.transmitted : scattering.reflected) / share;
        const glm::vec3 normal = through ? -hit->normal : hit->normal,
                        face = through ? -hit->face : hit->face;

        const auto lit = [&](const glm::vec3& towards) {
            return glm::dot(normal, towards) > 0 && glm::dot(face, towards) > 0;
        };
        for (const Sun& sun : light.suns())
            if (lit(sun.towards))
                radiance += throughput * sun.irradiance * glm::dot(normal, sun.towards) / kPi *
                            transmittance(origin_off(*hit, sun.towards), sun.towards);
        const DistantLight::Sample sample = light.sample(samples.next());
        if (sample.density > 0 && lit(sample.direction)) {
            const float cosine = glm::dot(normal, sample.direction) / kPi;
            radiance += throughput * sample.radiance * (cosine / (sample.density + cosine)) *
                        transmittance(origin_off(*hit, sample.direction), sample.direction);
        }

        direction = cosine_direction(normal, samples.next());
        if (!lit(direction)) // below the facet, though above the interpolated normal
            return radiance;
        cosine_density = glm::dot(normal, direction) / kPi;
        origin = origin_off(*hit, direction);
        from = 0;
        if (++vertex >= kFirstRoulette && options.bounces < 0) {
            const float survival = std::min(0.98f, largest(throughput));
            if (samples.next().x >= survival)
                return radiance;
            throughput /= survival;
        }
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
                sums_[i] += tracing.path(options_.camera.position, view, samples);
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
            const glm::vec3 view = unit_direction(frame_, options_, x + 0.5, y + 0.5);
            float from = 0;
            auto hit = tracing.nearest(options_.camera.position, view, from);
            while (hit && (!hit->scatters || scene_.surfaces().coverage(hit->point) < 0.5f)) {
                from = std::nextafter(hit->distance, kInfinity);
                hit = tracing.nearest(options_.camera.position, view, from);
            }
            mask.push_back(hit.has_value());
        }
    return mask;
}

} // namespace prt
