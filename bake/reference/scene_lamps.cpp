// Samples lights one by one, and emissive surfaces by area, whereas the baker samples solid angles. The two
// implementations share only the scene's definitions, cones and ranges.

#include "bake/reference/scene_lamps.h"

#include "bake/scene/punctual.h"
#include "bake/scene/transmittance.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace prt {
namespace {

/// Returns the strength of the lamp with this name; nothing if it is dark.
std::optional<glm::vec3> strength_of_name(const std::string& name, std::span<const TransferTerm> lamps,
                                          std::span<const glm::vec3> strengths) {
    for (std::size_t k = 0; k < lamps.size(); ++k)
        if (lamps[k].has_member(name) && strengths[k] != glm::vec3(0))
            return strengths[k];
    return std::nullopt;
}

std::array<glm::dvec3, 3> corners_of(const Surfaces& surfaces, std::uint32_t triangle) {
    const Scene& scene = surfaces.scene();
    const VertexArray& vertices =
        scene.vertex_arrays[scene.primitives[surfaces.primitive(triangle)].vertices];
    const glm::uvec3 at = surfaces.corners(triangle) - static_cast<unsigned>(vertices.first_receiver);
    return {glm::dvec3(vertices.positions[at.x]), glm::dvec3(vertices.positions[at.y]),
            glm::dvec3(vertices.positions[at.z])};
}

/// Approximate mean luminance of the triangle's emission, for the distribution of samples. A triangle that is
/// dark at its centroid may emit light elsewhere.
double brightness_of(const Surfaces& surfaces, std::uint32_t triangle, double area) {
    const SurfacePoint middle{triangle, glm::vec2(1.0f / 3), static_cast<float>(area)};
    return std::max(luminance(glm::dvec3(surfaces.emission(middle))),
                    0.1 * luminance(glm::dvec3(surfaces.material(triangle).emission.radiance)));
}

} // namespace

std::vector<TransferTerm> lamps_of(const Scene& scene) {
    std::vector<TransferTerm> lamps;
    const auto add = [&](const std::string& name) {
        if (std::ranges::none_of(lamps, [&](const TransferTerm& lamp) { return lamp.name == name; }))
            lamps.push_back({.kind = TermKind::lamp, .channels = 3, .name = name});
    };
    for (const PunctualLight& light : scene.lights)
        add(light.name);
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (scene.materials[m].emission.radiance != glm::vec3(0))
            add(lamp_name(scene, m));
    return lamps;
}

SceneLamps::SceneLamps(const TraceScene& scene, std::span<const TransferTerm> lamps,
                       std::span<const glm::vec3> strengths)
    : scene_(scene), strengths_(scene.scene().materials.size(), glm::vec3(0)) {
    if (strengths.size() != lamps.size())
        throw Error(fmt::format("{}, but {}", counted(lamps.size(), "lamp"),
                                counted(strengths.size(), "lamp strength")));
    const std::vector<PunctualLight>& lights = scene.scene().lights;
    for (std::uint32_t i = 0; i < lights.size(); ++i)
        if (const auto strength = strength_of_name(lights[i].name, lamps, strengths))
            lights_.push_back({i, *strength});
    const Surfaces& surfaces = scene.surfaces();
    for (std::size_t m = 0; m < strengths_.size(); ++m)
        if (scene.scene().materials[m].emission.radiance != glm::vec3(0))
            strengths_[m] =
                strength_of_name(lamp_name(scene.scene(), m), lamps, strengths).value_or(glm::vec3(0));
    double all = 0;
    densities_.assign(surfaces.triangles(), 0.0);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (strength_of(t) == glm::vec3(0))
            continue;
        const auto [a, b, c] = corners_of(surfaces, t);
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        densities_[t] = brightness_of(surfaces, t, area) * luminance(glm::dvec3(strength_of(t)));
        if (densities_[t] * area > 0)
            shining_.push_back({t, all += densities_[t] * area});
    }
    for (double& density : densities_)
        density = all > 0 ? density / all : 0;
    if (shining_.empty())
        densities_.clear();
}

glm::vec3 SceneLamps::strength_of(std::uint32_t triangle) const {
    const Surfaces& surfaces = scene_.surfaces();
    return strengths_[scene_.scene().primitives[surfaces.primitive(triangle)].material];
}

SceneLamps::Sample SceneLamps::of_light(const Light& light, const glm::vec3& receiver) const {
    const PunctualLight& l = scene_.scene().lights[light.index];
    Sample sample;
    sample.irradiance = light.strength * l.intensity;
    if (l.kind == PunctualKind::directional) {
        sample.towards = -l.direction;
        sample.way = sample.towards;
        sample.reach = std::numeric_limits<float>::infinity();
        return sample;
    }
    sample.way = l.position - receiver;
    const double distance = glm::length(glm::dvec3(sample.way));
    sample.towards = distance > 0 ? glm::vec3(glm::dvec3(sample.way) / distance) : -l.direction;
    const double near = std::max(distance, kNearestToLight);
    sample.irradiance *= static_cast<float>(cone_share(l, -glm::dvec3(sample.towards)) *
                                            range_share(l, distance) / (near * near));
    return sample;
}

SceneLamps::Sample SceneLamps::sample_light(const glm::vec3& receiver, float u) const {
    // A part of the probability is uniform, so that a hidden light does not take more than its share.
    double all = 0;
    const auto weight = [&](const Light& light) {
        return luminance(glm::dvec3(of_light(light, receiver).irradiance));
    };
    for (const Light& light : lights_)
        all += weight(light);
    if (!(all > 0))
        return {};
    double target = static_cast<double>(u);
    for (const Light& light : lights_) {
        const double share = 0.8 * weight(light) / all + 0.2 / static_cast<double>(lights_.size());
        if (target < share || &light == &lights_.back()) {
            Sample sample = of_light(light, receiver);
            sample.irradiance /= static_cast<float>(share);
            return sample;
        }
        target -= share;
    }
    return {};
}

SceneLamps::Sample SceneLamps::sample_surface(const glm::vec3& receiver, const glm::vec2& u) const {
    const double target = static_cast<double>(u.x) * shining_.back().until;
    const auto found = std::upper_bound(shining_.begin(), shining_.end() - 1, target,
                                        [](double x, const Shining& s) { return x < s.until; });
    const double before = found == shining_.begin() ? 0 : (found - 1)->until;
    const double rest = std::clamp((target - before) / (found->until - before), 0.0, 1.0);
    const double root = std::sqrt(rest), v = static_cast<double>(u.y);
    const glm::dvec2 uv(root * (1 - v), root * v);
    const auto [a, b, c] = corners_of(scene_.surfaces(), found->triangle);
    const glm::dvec3 to = a + uv.x * (b - a) + uv.y * (c - a) - glm::dvec3(receiver);
    const double distance = glm::length(to);
    const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
    Sample sample;
    if (!(distance > 0))
        return sample;
    const double cosine = -glm::dot(face, to) / distance;
    sample.towards = glm::vec3(to / distance);
    const auto off =
        static_cast<double>(scene_.rays().triangle_offset(found->triangle, static_cast<float>(distance)));
    sample.way = glm::vec3(to + std::copysign(off, cosine) * face); // the visible side, not the triangle
                                                                    // itself
    sample.density =
        density(found->triangle, static_cast<float>(distance), static_cast<float>(std::abs(cosine)));
    const SurfacePoint point{found->triangle, glm::vec2(uv), 0};
    if (sample.density > 0 && std::isfinite(sample.density))
        sample.irradiance =
            radiance(point, cosine < 0) * (scene_.surfaces().coverage(point) / sample.density);
    return sample;
}

float SceneLamps::open(const glm::vec3& receiver, const Sample& sample) const {
    return transmittance(scene_.rays(), scene_.surfaces(), receiver, sample.way, sample.reach);
}

glm::vec3 SceneLamps::radiance(const SurfacePoint& point, bool back) const {
    if (densities_.empty() || (back && !scene_.surfaces().material(point.triangle).double_sided))
        return glm::vec3(0);
    const glm::vec3 strength = strength_of(point.triangle);
    return strength != glm::vec3(0) ? strength * scene_.surfaces().emission(point) : glm::vec3(0);
}

float SceneLamps::density(std::uint32_t triangle, float distance, float cosine) const {
    if (densities_.empty() || densities_[triangle] == 0)
        return 0;
    return static_cast<float>(densities_[triangle] * static_cast<double>(distance) *
                              static_cast<double>(distance) / std::max(1e-12, static_cast<double>(cosine)));
}

} // namespace prt
