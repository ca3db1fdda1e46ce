// Traces light paths.

#include "bake/reference/light_paths.h"

#include "bake/scene/transmittance.h"
#include "runtime/core/support/tangent_frame.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

constexpr float kFarAway = std::numeric_limits<float>::infinity();
constexpr float kPi = std::numbers::pi_v<float>;
/// First vertex at which Russian roulette may end a path, if the number of bounces is not limited.
constexpr int kFirstRoulette = 4;

float unit(std::uint32_t reversed) {
    return static_cast<float>(reverse_bits(reversed) >> 8) * 0x1p-24f;
}

float largest(const glm::vec3& v) {
    return std::max({v.r, v.g, v.b});
}

} // namespace

glm::vec3 cosine_direction(const glm::vec3& normal, const glm::vec2& u) {
    const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
    const TangentFrame frame = tangent_frame(normal);
    return frame.tangent * (radius * std::cos(angle)) + frame.bitangent * (radius * std::sin(angle)) +
           frame.normal * std::sqrt(std::max(0.0f, 1 - u.x));
}

glm::vec2 PathSamples::next() {
    const std::uint32_t hash = pcg_hash(seed_ + 3 * ++pair_);
    const SobolOffset point = sobol_offset(reverse_bits(laine_karras(reversed_, hash)));
    return {unit(laine_karras(point.x, pcg_hash(hash + 1))), unit(laine_karras(point.y, pcg_hash(hash + 2)))};
}

std::optional<SurfaceHit> LightPaths::nearest(const Ray& ray) const {
    const std::optional<RayHit> met = scene.rays().nearest(ray);
    if (!met)
        return std::nullopt;
    const SurfacePoint point{met->triangle, met->uv, 0};
    const MetSurface surface = met_surface(scene.scene(), scene.rays(), point, ray.direction);
    return SurfaceHit{met->distance, point, surface.side,
                      !surface.back || scene.surfaces().two_sided(met->triangle), surface.back};
}

void LightPaths::add_background(LightPath& path) const {
    if (path.from_camera() && !rules.background)
        return;
    const DistantLight& from = path.vertices <= 1 ? light.first : light.bounced;
    const float light_density = path.from_camera() ? 0.0f : from.density(path.ray.direction);
    const float weight = path.from_camera() ? 1.0f : *path.density / (*path.density + light_density);
    path.radiance += path.throughput * from.radiance(path.ray.direction) * weight;
}

/// Chooses one of the two sides in proportion to its scattering; nothing if neither scatters.
std::optional<LitSide> LightPaths::choose_side(const SurfaceHit& hit, LightPath& path,
                                               PathSamples& samples) const {
    const Scattering scattering = path.from_camera()
                                      ? seen_scattering(scene.surfaces(), hit.point, rules.textured)
                                      : scene.surfaces().scattering(hit.point);
    const float reflected = largest(scattering.reflected), transmitted = largest(scattering.transmitted);
    if (!(reflected + transmitted > 0))
        return std::nullopt;
    const bool through = samples.next().x * (reflected + transmitted) >= reflected;
    const float share = (through ? transmitted : reflected) / (reflected + transmitted);
    path.throughput *= (through ? scattering.transmitted : scattering.reflected) / share;
    return through ? hit.side.other() : hit.side;
}

void LightPaths::add_direct_light(const LitSide& side, LightPath& path, PathSamples& samples) const {
    const DistantLight& from = path.vertices == 0 ? light.first : light.bounced;
    for (const Sun& sun : from.suns())
        if (side.faces(sun.towards))
            path.radiance += path.throughput * sun.irradiance * glm::dot(side.normal, sun.towards) / kPi *
                             transmittance(scene.rays(), scene.surfaces(), side.origin(), sun.towards);
    const DistantLight::Sample sample = from.sample(samples.next());
    if (sample.density > 0 && side.faces(sample.direction)) {
        const float cosine = glm::dot(side.normal, sample.direction) / kPi;
        path.radiance += path.throughput * sample.radiance * (cosine / (sample.density + cosine)) *
                         transmittance(scene.rays(), scene.surfaces(), side.origin(), sample.direction);
    }
}

void LightPaths::add_lamp_light(const LitSide& side, LightPath& path, PathSamples& samples) const {
    const auto add = [&](const SceneLamps::Sample& sample) {
        if (sample.irradiance == glm::vec3(0) || !side.faces(sample.towards))
            return;
        const float cosine = glm::dot(side.normal, sample.towards) / kPi;
        path.radiance += path.throughput * sample.irradiance *
                         (cosine * sample.balance(cosine) * light.lamps->open(side.origin(), sample));
    };
    if (light.lamps->has_lights())
        add(light.lamps->sample_light(side.origin(), samples.next().x));
    if (light.lamps->has_surfaces())
        add(light.lamps->sample_surface(side.origin(), samples.next()));
}

/// Adds the emission of a surface, weighted against samples of that surface.
void LightPaths::add_emission(const SurfaceHit& hit, LightPath& path) const {
    if (path.from_camera() && !rules.lamps)
        return;
    const glm::vec3 radiance = light.lamps->radiance(hit.point, hit.back);
    if (radiance == glm::vec3(0))
        return;
    const float cosine = std::abs(glm::dot(hit.side.face, path.ray.direction));
    const float weight = path.from_camera()
                             ? 1.0f
                             : *path.density / (*path.density + light.lamps->density(hit.point.triangle,
                                                                                     hit.distance, cosine));
    path.radiance += path.throughput * radiance * weight;
}

/// Continues in a cosine-distributed direction.
bool LightPaths::bounce(const LitSide& side, LightPath& path, PathSamples& samples) const {
    const glm::vec3 direction = cosine_direction(side.normal, samples.next());
    if (!side.faces(direction)) // below the triangle, though above the interpolated normal
        return false;
    path.density = glm::dot(side.normal, direction) / kPi;
    path.ray = {side.origin(), direction};
    if (++path.vertices < kFirstRoulette || rules.bounces >= 0)
        return true;
    const float survival = std::min(0.98f, largest(path.throughput));
    if (samples.next().x >= survival)
        return false;
    path.throughput /= survival;
    return true;
}

bool LightPaths::scatter(const SurfaceHit& hit, LightPath& path, PathSamples& samples) const {
    if (!hit.scatters || (rules.bounces >= 0 && path.vertices > rules.bounces))
        return false;
    const std::optional<LitSide> side = choose_side(hit, path, samples);
    if (!side)
        return false;
    add_direct_light(*side, path, samples);
    if (light.lamps)
        add_lamp_light(*side, path, samples);
    return bounce(*side, path, samples);
}

bool LightPaths::follow(LightPath& path, PathSamples& samples) const {
    for (;;) {
        const std::optional<SurfaceHit> hit = nearest(path.ray);
        if (!hit) {
            add_background(path);
            return true;
        }
        // The camera sees through back sides, as in pictures; light does not pass them.
        if ((path.from_camera() && !hit->scatters) ||
            samples.next().x >= scene.surfaces().coverage(hit->point))
            path.ray.from = std::nextafter(hit->distance, kFarAway);
        else {
            if (light.lamps)
                add_emission(*hit, path);
            if (!scatter(*hit, path, samples))
                return false;
        }
    }
}

} // namespace prt
