// Samples lamps by their solid angles, so that no light is too near.

#include "lamps/lamp_rays.h"

#include "lamps/punctual.h"
#include "lamps/spherical_triangle.h"
#include "prt/color.h"
#include "scene/transmittance.h"
#include "trace/disc_share.h"

#include <glm/common.hpp>

#include <numbers>

namespace prt {
namespace {

/// Even steps of a sequence in 0..1 that stays even wherever it ends (the golden ratio).
double golden(int i, double begin) {
    const double x = begin + i * (std::numbers::phi - 1);
    return x - std::floor(x);
}

double unit_number(std::uint32_t seed) {
    return 0x1p-32 * static_cast<double>(seed);
}

/// Where a light is seen from a receiver, and what it gives there unless something is in its way.
struct SeenLight {
    const PunctualLight* light;
    glm::dvec3 towards{0}; ///< unit
    double distance = 0;   ///< metres; infinite where directional
    glm::dvec3 normal_irradiance{0};
    double weight = 0; ///< luminance of the irradiance, about
};

SeenLight seen(const PunctualLight& light, const LampReceiver& receiver, double radius) {
    SeenLight seen{&light};
    seen.normal_irradiance = glm::dvec3(light.intensity);
    double reach = 0; // how far a light that is partly below the horizon still comes up
    if (light.kind == PunctualKind::directional) {
        seen.towards = -glm::dvec3(light.direction);
        reach = std::sin(static_cast<double>(light.half_angle));
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

/// Distance to a sphere along a direction of that cosine to its middle; 0 within it, infinite where it is.
double distance_to_sphere(double distance, double cosine, double radius) {
    if (distance <= radius)
        return 0;
    if (radius <= 0 || std::isinf(distance))
        return distance;
    const double across = distance * distance * (1 - cosine * cosine);
    return distance * cosine - std::sqrt(std::max(0.0, radius * radius - across));
}

/// Half angle of the cone that a light fills, radians; within a sphere light comes from everywhere.
double half_angle_of(const SeenLight& light, double radius) {
    if (light.light->kind == PunctualKind::directional)
        return static_cast<double>(light.light->half_angle);
    if (radius <= 0)
        return 0;
    return radius < light.distance ? std::asin(radius / light.distance) : std::numbers::pi / 2;
}

/// Share of the light that arrives, with its cosine; 1 for what faces it and is open.
double arriving(const TraceScene& scene, const SeenLight& light, const LampReceiver& receiver, double radius,
                int rays) {
    const DiscDirections directions(glm::vec3(light.towards), half_angle_of(light, radius), rays);
    return share_of_disc(scene, receiver.origin, receiver.normal, directions,
                         2 * std::numbers::pi * unit_number(receiver.seed), [&](int i) {
                             return static_cast<float>(
                                 distance_to_sphere(light.distance, directions.cosine(i), radius));
                         });
}

/// A point of a triangle that shines, as sampled.
struct ShiningPoint {
    glm::dvec3 place;
    glm::vec2 uv;
    double angle; ///< solid angle that it stands for
};

/// Even over the solid angle, or where that is so small that there is no difference, over the area.
ShiningPoint point_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double angle,
                      const glm::dvec3& from, const glm::dvec2& u) {
    constexpr double kSmall = 1e-3;
    const glm::dvec3 ab = b - a, ac = c - a, normal = glm::cross(ab, ac);
    if (angle < kSmall) {
        const double root = std::sqrt(u.x);
        const glm::vec2 uv(static_cast<float>(root * (1 - u.y)), static_cast<float>(root * u.y));
        const glm::dvec3 place = a + static_cast<double>(uv.x) * ab + static_cast<double>(uv.y) * ac,
                         to = place - from;
        const double square = glm::dot(to, to);
        return {place, uv, 0.5 * std::abs(glm::dot(normal, to)) / (square * std::sqrt(square))};
    }
    const glm::dvec3 direction =
        direction_in(glm::normalize(a - from), glm::normalize(b - from), glm::normalize(c - from), angle, u);
    const double along = glm::dot(a - from, normal) / glm::dot(direction, normal);
    const glm::dvec3 place = from + along * direction, inside = place - a;
    const double square = glm::dot(normal, normal);
    const glm::dvec2 uv(glm::dot(glm::cross(inside, ac), normal) / square,
                        glm::dot(glm::cross(ab, inside), normal) / square);
    return {place, glm::vec2(glm::clamp(uv, 0.0, 1.0)), angle};
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
                             ? std::max(1, static_cast<int>(std::ceil(most * light.weight / all)))
                             : 1;
        result.irradiance += light.normal_irradiance * arriving(scene, light, receiver, radius, rays);
        result.rays += static_cast<std::size_t>(rays);
    }
    return result;
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
        // A texel as large as the triangle, at its middle, is the mean or near to it: it only steers. Where
        // one of four times that is black, all is.
        const SurfacePoint middle{t, glm::vec2(1.0f / 3), static_cast<float>(area)};
        const glm::vec3 mean = surfaces.emission(middle);
        if (mean == glm::vec3(0) && surfaces.emission({t, middle.uv, 4 * middle.footprint}) == glm::vec3(0))
            continue;
        // What is dark at its middle may shine elsewhere.
        const double least = 0.05 * luminance(glm::dvec3(surfaces.material(t).emission.radiance));
        if (area > 0)
            triangles_.push_back({t, a, b, c, std::max(luminance(glm::dvec3(mean)), least),
                                  surfaces.material(t).double_sided});
    }
}

glm::dvec3 ShiningTriangles::irradiance_along(const LampReceiver& receiver, const Shining& t, double angle,
                                              const glm::dvec2& u) const {
    const glm::dvec3 from(receiver.origin);
    const ShiningPoint point = point_of(t.a, t.b, t.c, angle, from, u);
    const double cosine = glm::dot(glm::dvec3(receiver.normal), glm::normalize(point.place - from));
    if (!(cosine > 0))
        return glm::dvec3(0);
    // The ray ends on the side that is seen, not on the triangle itself.
    glm::dvec3 outward = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
    if (glm::dot(outward, point.place - from) > 0)
        outward = -outward;
    const auto off = static_cast<double>(scene_.rays().triangle_offset(t.triangle));
    const glm::vec3 way(point.place + off * outward - glm::dvec3(receiver.origin));
    const float open = transmittance(scene_.rays(), scene_.surfaces(), receiver.origin, way, 1);
    if (open <= 0)
        return glm::dvec3(0);
    const SurfacePoint seen{t.triangle, point.uv, 0};
    const glm::dvec3 radiance =
        glm::dvec3(scene_.surfaces().emission(seen)) * static_cast<double>(scene_.surfaces().coverage(seen));
    return radiance * (cosine * static_cast<double>(open) * point.angle / angle);
}

LampIrradiance ShiningTriangles::irradiance(const LampReceiver& receiver, int rays) const {
    // From where rays start: in the plane of a wall that shines its solid angle is none, and a hair before it
    // half of all there is.
    const glm::dvec3 position(receiver.origin), normal(receiver.normal);
    struct Seen {
        const Shining* shining;
        double angle, until; ///< solid angle, and the sum of all weights so far
    };
    thread_local std::vector<Seen> seen;
    seen.clear();
    double all = 0;
    for (const Shining& t : triangles_) {
        const glm::dvec3 a = t.a - position, b = t.b - position, c = t.c - position;
        const bool below = std::max({glm::dot(a, normal), glm::dot(b, normal), glm::dot(c, normal)}) <= 0;
        if (below || (!t.two_sided && glm::dot(glm::cross(b - a, c - a), a) >= 0))
            continue;
        const double angle = solid_angle(a, b, c);
        if (angle > 0)
            seen.push_back({&t, angle, all += angle * t.luminance});
    }
    LampIrradiance result;
    if (seen.empty())
        return result;
    std::size_t at = 0;
    double before = 0;
    for (int i = 0; i < rays; ++i) {
        const double target = all * (i + unit_number(receiver.seed)) / rays;
        for (; at + 1 < seen.size() && seen[at].until <= target; ++at)
            before = seen[at].until;
        const Shining& t = *seen[at].shining;
        const glm::dvec2 u(std::clamp((target - before) / (seen[at].until - before), 0.0, 1.0),
                           golden(i, unit_number(receiver.seed * 2654435761u)));
        result.irradiance += irradiance_along(receiver, t, seen[at].angle, u) * (all / (t.luminance * rays));
        ++result.rays;
    }
    return result;
}

} // namespace prt
