// Projects disc lights. Seen from the origin a disc fills an elliptic cone. About the axis of that cone its
// coefficients are integrals of a smooth function over a quarter of an ellipse (docs/math.md, eq. 13).

#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "runtime/core/light/finite_light.h"
#include "runtime/core/sh/gauss_legendre.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace prt {
namespace {

using std::numbers::pi;
using Coefficients = std::array<double, kMaxOrder * kMaxOrder>;

/// The cone { z > 0, (x / wide)² + (y / narrow)² <= z² } in a frame with the columns of `frame` as axes.
struct EllipticCone {
    glm::dmat3 frame;
    double wide, narrow; ///< tangents of its half angles, wide >= narrow
};

/// Returns direction and length of the offset from the foot of the origin on the disc's plane to the disc's
/// center. If the two points nearly coincide, the difference is rounding error in an arbitrary direction, and
/// not in the plane. The component out of the plane is therefore removed, and an offset within the rounding
/// error counts as 0.
std::pair<glm::dvec3, double> sideways(const glm::dvec3& center, const glm::dvec3& normal, double height) {
    constexpr double kRounding = 1e-12; // relative to the height; 1000 times the rounding of doubles
    const auto in_plane = [&](const glm::dvec3& v) { return v - glm::dot(v, normal) * normal; };
    const glm::dvec3 lateral = in_plane(center + height * normal);
    const double offset = glm::length(lateral);
    if (offset > kRounding * height)
        return {glm::normalize(in_plane(lateral / offset)), offset};
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return {glm::normalize(glm::cross(other, normal)), 0};
}

/// Returns the cone of a disc. `normal` points from the disc to the side of the origin, which is `height` > 0
/// above the plane.
EllipticCone cone_through(const glm::dvec3& center, const glm::dvec3& normal, double height, double radius) {
    const auto [side, offset] = sideways(center, normal, height);
    // In the plane of symmetry the nearest and farthest points of the rim are at angles a1 and a2 from the
    // downward direction, tan a = (offset -+ radius) / height. The following are half of their difference and
    // sum, without cancellation:
    const double beyond = (offset - radius) * (offset + radius);
    const double half_angle = 0.5 * std::atan2(2 * radius * height, beyond + height * height);
    const double elevation = 0.5 * std::atan2(2 * offset * height, beyond - height * height); // elevation of
                                                                                              // the axis
    const double sine = std::sin(elevation), cosine = std::cos(elevation);
    // Half of the chord across, at the point where the axis intersects the disc's plane, from the two
    // segments of the diameter.
    const double meets = height * cosine / sine;
    const double chord = std::sqrt(std::max(0.0, (meets - (offset - radius)) * (offset + radius - meets)));
    const double in_plane = std::tan(half_angle), across = chord * sine / height;
    const glm::dvec3 axis = cosine * side - sine * normal, in = sine * side + cosine * normal,
                     out = glm::cross(axis, in);
    if (in_plane >= across)
        return {glm::dmat3(in, out, axis), in_plane, across};
    return {glm::dmat3(out, -in, axis), across, in_plane};
}

/// Adds the integral over the angles from 0 to the rim at parameter `t`, times `weight`, of the functions
/// that have the same sign in all quadrants: even m >= 0. The rim is (wide cos t, narrow sin t, 1), and the
/// azimuth changes by wide narrow / distance² per dt.
void add_ray(const EllipticCone& cone, double t, double weight, const GaussLegendre& nodes,
             Coefficients& sum) {
    const double x = cone.wide * std::cos(t), y = cone.narrow * std::sin(t), distance = std::hypot(x, y);
    if (!(distance > 0))
        return;
    const double azimuth_share = (cone.wide / distance) * (cone.narrow / distance);
    const double angle = std::atan(distance);
    std::array<double, kMaxOrder * kMaxOrder> basis;
    for (std::size_t k = 0; k < nodes.nodes.size(); ++k) {
        const double theta = 0.5 * angle * (1 + nodes.nodes[k]), sine = std::sin(theta);
        evaluate_sh(kMaxOrder, glm::dvec3(sine * x / distance, sine * y / distance, std::cos(theta)),
                    std::span<double>(basis));
        const double share = weight * azimuth_share * 0.5 * angle * nodes.weights[k] * sine;
        for (int l = 0; l < kMaxOrder; ++l)
            for (int m = 0; m <= l; m += 2)
                sum[static_cast<std::size_t>(sh_index(l, m))] +=
                    share * basis[static_cast<std::size_t>(sh_index(l, m))];
    }
}

/// Integrates the cone about its axis. For an elongated cone the integrand changes within max(narrow, 1) /
/// wide of t = pi/2; intervals are halved towards it until they resolve that width.
Coefficients covered(const EllipticCone& cone) {
    constexpr int kMaxHalvings = 50; // smaller intervals contribute less than rounding
    static const GaussLegendre nodes(16);
    const double width = std::max(cone.narrow, 1.0) / cone.wide;
    const int halvings =
        width < 1 ? static_cast<int>(std::min<double>(std::ceil(-std::log2(width)), kMaxHalvings)) : 0;
    Coefficients sum{};
    for (int interval = 0; interval <= halvings + 1; ++interval) {
        // distances from pi/2
        const double far = 0.5 * pi * std::exp2(-interval), near = interval == halvings + 1 ? 0 : 0.5 * far;
        for (std::size_t k = 0; k < nodes.nodes.size(); ++k) {
            const double from_end = near + 0.5 * (far - near) * (1 + nodes.nodes[k]);
            add_ray(cone, 0.5 * pi - from_end, 4 * 0.5 * (far - near) * nodes.weights[k], nodes, sum);
        }
    }
    return sum;
}

} // namespace

Light disc_light(int order, const glm::vec3& center, const glm::vec3& normal, double radius,
                 const glm::vec3& radiance) {
    check_order(order);
    if (!(radius > 0 && std::isfinite(radius)))
        throw Error("the radius of a disc light must be positive and finite");
    const double length = glm::length(glm::dvec3(normal));
    if (!(length > 0 && std::isfinite(length)))
        throw Error("the normal of a disc light has length " + std::to_string(length) +
                    ", but must be finite and not 0");
    const glm::dvec3 n = glm::dvec3(normal) / length, c(center);
    const double height = -glm::dot(n, c);
    if (!std::isfinite(height))
        throw Error("the center of a disc light must be finite");
    Light light{order,
                std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(order)), glm::vec3(0))};
    if (!(height > 0)) // the origin is behind the disc
        return light;
    const EllipticCone cone = cone_through(c, n, height, radius);
    if (!(cone.narrow > 0)) // edge-on, to rounding
        return light;
    const Coefficients about_axis = covered(cone);
    Coefficients sum{};
    ShRotation(kMaxOrder, cone.frame).apply(std::span<const double>(about_axis), std::span<double>(sum));
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        light.coefficients[i] = glm::vec3(glm::dvec3(radiance) * sum[i]);
    return finite_light(std::move(light));
}

} // namespace prt
