// Samples lamps by solid angle, so that no light is too near.

#include "bake/trace/lamp_rays.h"

#include "bake/scene/punctual.h"
#include "bake/scene/transmittance.h"
#include "bake/trace/disc_share.h"
#include "prt/core/light.h"

#include <glm/common.hpp>

#include <numbers>

namespace prt {
namespace {

/// Position of a light relative to a receiver, and its unoccluded light there.
struct SeenLight {
    const PunctualLight* light;
    glm::dvec3 towards{0}; ///< unit
    double distance = 0;   ///< metres; infinite for directional lights
    glm::dvec3 normal_irradiance{0};
    double weight = 0; ///< approximate luminance of the irradiance
};

SeenLight seen(const PunctualLight& light, const LampReceiver& receiver, double radius) {
    SeenLight seen{&light};
    seen.normal_irradiance = glm::dvec3(light.intensity);
    double reach = 0; // sine of the angle by which a light below the horizon is partly visible
    if (light.kind == PunctualKind::directional) {
        seen.towards = -glm::dvec3(light.direction);
        seen.distance = std::numeric_limits<double>::infinity();
    } else {
        const glm::dvec3 to = glm::dvec3(light.position) - glm::dvec3(receiver.position);
        seen.distance = glm::length(to);
        const double near = std::max({seen.distance, radius, kNearestToLight});
        seen.towards = seen.distance > 0 ? to / seen.distance : glm::dvec3(receiver.normal);
        seen.normal_irradiance *=
            cone_share(light, -seen.towards) * range_share(light, seen.distance) / (near * near);
        reach = radius / near;
    }
    const double cosine = glm::dot(glm::dvec3(receiver.normal), seen.towards);
    seen.weight = luminance(seen.normal_irradiance) * std::max(0.0, std::min(1.0, cosine + reach));
    return seen;
}

/// Half angle of the cone that a light fills, radians: 0 for a directional light, which is infinitely far;
/// inside the sphere of a light pi/2, because light arrives from everywhere.
double half_angle_of(const SeenLight& light, double radius) {
    if (radius <= 0)
        return 0;
    return radius < light.distance ? std::asin(radius / light.distance) : std::numbers::pi / 2;
}

/// Share of the light that arrives, including the cosine; 1 for a receiver that faces it without occlusion.
double arriving(const TraceScene& scene, const SeenLight& light, const LampReceiver& receiver, double radius,
                int rays) {
    const DiscDirections directions(glm::vec3(light.towards), half_angle_of(light, radius), rays);
    return share_of_disc(scene, receiver.origin, receiver.normal, directions,
                         2 * std::numbers::pi * lamp_geometry::unit_number(receiver.seed), [&](int i) {
                             if (radius <= 0 || std::isinf(light.distance))
                                 return static_cast<float>(light.distance);
                             return static_cast<float>(lamp_geometry::distance_to_sphere(
                                 light.distance, 1 - directions.cosine(i), radius));
                         });
}

} // namespace

LampIrradiance irradiance_of_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                                    double radius, int most) {
    std::vector<SeenLight> lights;
    double all = 0;
    for (const std::uint32_t i : lamp.lights) {
        const SeenLight light = seen(scene.scene().lights[i], receiver, radius);
        if (light.weight > 0) {
            lights.push_back(light);
            all += light.weight;
        }
    }
    LampIrradiance result;
    for (const SeenLight& light : lights) {
        const int rays = half_angle_of(light, radius) > 0
                             ? static_cast<int>(lamp_geometry::rays_of_share(static_cast<std::uint32_t>(most),
                                                                             light.weight / all))
                             : 1;
        result.irradiance += light.normal_irradiance * arriving(scene, light, receiver, radius, rays);
        result.rays += static_cast<std::size_t>(rays);
    }
    return result;
}

std::size_t take_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                        double radius, int most, const TakeLight& take) {
    std::size_t rays = 0;
    for (const std::uint32_t i : lamp.lights) {
        LampReceiver facing = receiver;
        const SeenLight where = seen(scene.scene().lights[i], receiver, radius);
        facing.normal = glm::vec3(where.towards);
        Lamp one;
        one.lights = {i};
        const LampIrradiance light = irradiance_of_lights(scene, one, facing, radius, most);
        rays += light.rays;
        if (light.irradiance != glm::dvec3(0))
            take(where.towards, light.irradiance);
    }
    return rays;
}

ShiningTriangles::ShiningTriangles(const TraceScene& scene, const Lamp& lamp) : scene_(scene) {
    const Surfaces& surfaces = scene.surfaces();
    for (const std::uint32_t t : lamp.triangles) {
        const std::size_t p = surfaces.primitive(t);
        const Primitive& primitive = scene.scene().primitives[p];
        const VertexArray& vertices = scene.scene().vertex_arrays[primitive.vertices];
        const glm::uvec3 corners = surfaces.corners(t) - static_cast<unsigned>(vertices.first_receiver);
        const glm::dvec3 a(vertices.positions[corners.x]), b(vertices.positions[corners.y]),
            c(vertices.positions[corners.z]);
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        // A texel of the size of the triangle at its centroid is about its mean; it only steers the sampling.
        // The triangle is dark if a texel of four times this size is also black.
        const SurfacePoint middle{t, glm::vec2(1.0f / 3), static_cast<float>(area)};
        const glm::vec3 mean = surfaces.emission(middle);
        if (mean == glm::vec3(0) && surfaces.emission({t, middle.uv, 4 * middle.footprint}) == glm::vec3(0))
            continue;
        // A triangle that is dark at its centroid may emit light elsewhere.
        const double least = 0.05 * luminance(glm::dvec3(surfaces.material(t).emission.radiance));
        if (area > 0)
            triangles_.push_back({t, a, b, c, std::max(luminance(glm::dvec3(mean)), least),
                                  surfaces.material(t).double_sided});
    }
}

ShiningTriangles::Sample ShiningTriangles::sample(const LampReceiver& receiver, const Shining& t,
                                                  const lamp_geometry::SeenTriangle& seen,
                                                  const glm::dvec2& u) const {
    const lamp_geometry::TrianglePoint point = lamp_geometry::point_of(seen, u);
    const glm::dvec3 towards = glm::normalize(point.position);
    if (!(glm::dot(glm::dvec3(receiver.normal), towards) > 0))
        return {};
    // The ray ends on the visible side, not on the triangle itself.
    const glm::dvec3 outward = glm::normalize(seen.volume > 0 ? -seen.normal : seen.normal);
    const auto off = static_cast<double>(
        scene_.rays().triangle_offset(t.triangle, static_cast<float>(glm::length(point.position))));
    const glm::vec3 way(point.position + off * outward);
    const float open = transmittance(scene_.rays(), scene_.surfaces(), receiver.origin, way, 1);
    if (open <= 0)
        return {};
    const SurfacePoint surface_point{t.triangle, glm::vec2(point.uv), 0};
    const glm::dvec3 radiance = glm::dvec3(scene_.surfaces().emission(surface_point)) *
                                static_cast<double>(scene_.surfaces().coverage(surface_point));
    return {towards, radiance * (static_cast<double>(open) * point.angle / seen.angle)};
}

LampIrradiance ShiningTriangles::irradiance(const LampReceiver& receiver, int rays) const {
    LampIrradiance result;
    const glm::dvec3 normal(receiver.normal);
    result.rays = take_light(receiver, rays, [&](const glm::dvec3& towards, const glm::dvec3& irradiance) {
        result.irradiance += glm::dot(normal, towards) * irradiance;
    });
    return result;
}

std::size_t ShiningTriangles::take_light(const LampReceiver& receiver, int rays,
                                         const TakeLight& take) const {
    // From the origin of rays: in the plane of an emissive wall the wall's solid angle is zero, and slightly
    // in front of it half of the sphere.
    const glm::dvec3 from(receiver.origin), normal(receiver.normal);
    const auto see = [&](const Shining& t) {
        return lamp_geometry::see_triangle(t.a - from, t.b - from, t.c - from, t.b - t.a, t.c - t.a, normal,
                                           t.two_sided);
    };
    struct Weighted {
        const Shining* shining;
        double until; ///< sum of all weights up to and including this one
    };
    thread_local std::vector<Weighted> weighted;
    weighted.clear();
    double all = 0;
    for (const Shining& t : triangles_) {
        const double angle = see(t).angle;
        if (angle > 0)
            weighted.push_back({&t, all += angle * t.luminance});
    }
    if (weighted.empty())
        return 0;
    const double shift = lamp_geometry::unit_number(receiver.seed);
    std::size_t at = 0;
    double before = 0;
    for (int i = 0; i < rays; ++i) {
        const double target = all * (i + shift) / rays;
        for (; at + 1 < weighted.size() && weighted[at].until <= target; ++at)
            before = weighted[at].until;
        const Weighted& t = weighted[at];
        const glm::dvec2 u(std::clamp((target - before) / (t.until - before), 0.0, 1.0),
                           lamp_geometry::golden(static_cast<std::uint32_t>(i), receiver.seed * 2654435761u));
        const Sample light = sample(receiver, *t.shining, see(*t.shining), u);
        if (light.irradiance != glm::dvec3(0))
            take(light.towards, light.irradiance * (all / (t.shining->luminance * rays)));
    }
    return static_cast<std::size_t>(rays);
}

} // namespace prt
