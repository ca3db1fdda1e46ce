#pragma once

// A triangle as it is seen from a point: J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH
// 1995.

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace prt {

/// Solid angle of the triangle with these corners, seen from the origin (A. van Oosterom, J. Strackee, 1983).
inline double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
    const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
    return volume > 0 ? 2 * std::atan2(volume, below) : 0;
}

/// The unit direction at `u` in 0..1 by 0..1 of an even map onto the spherical triangle of unit corners.
inline glm::dvec3 direction_in(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double area,
                               const glm::dvec2& u) {
    const auto beside = [](const glm::dvec3& x, const glm::dvec3& y) { // unit, the part of x across y
        return glm::normalize(x - glm::dot(x, y) * y);
    };
    const double cos_alpha = std::clamp(glm::dot(beside(b, a), beside(c, a)), -1.0, 1.0);
    const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha), alpha = std::acos(cos_alpha);
    const double s = std::sin(u.x * area - alpha), t = std::cos(u.x * area - alpha);
    const double p = t - cos_alpha, v = s + sin_alpha * glm::dot(a, b);
    const double below = (v * s + p * t) * sin_alpha;
    const double q = below != 0 ? std::clamp(((v * t - p * s) * cos_alpha - v) / below, -1.0, 1.0) : 1;
    const glm::dvec3 cut = q * a + std::sqrt(1 - q * q) * beside(c, a); // on the side from a to c
    const double z = 1 - u.y * (1 - glm::dot(cut, b));
    return glm::normalize(z * b + std::sqrt(std::max(0.0, 1 - z * z)) * beside(cut, b));
}

} // namespace prt
