#pragma once

// Lighting as SH coefficients: L_c[i] = ∫ L_c(w) Y_i(w) dw, colours linear Rec. 709.

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

struct Light {
    int order = 0;
    std::vector<glm::vec3> coefficients; ///< [order²] of RGB
};

enum class Window { none, hann, lanczos, automatic };

/// Radiance `radiance` from every direction.
Light constant_light(int order, const glm::vec3& radiance);

/// A distant light of irradiance `irradiance` on a receiver that faces it; `towards` is the unit direction
/// from the receiver to the light.
Light directional_light(int order, const glm::vec3& towards, const glm::vec3& irradiance);

/// Radiance `radiance` inside the cone of half angle `half_angle` (radians, at most pi) about unit `axis`,
/// zero outside. Closed form: docs/math.md, eq. 9.
Light cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& radiance);

/// The CIE overcast sky about +Y over black ground: radiance `zenith` (1 + 2 y) / 3 for y >= 0.
Light overcast_sky(int order, const glm::vec3& zenith);

/// The radiance of the SH expansion in unit direction `direction`.
glm::vec3 radiance(const Light& light, const glm::vec3& direction);

/// The first `order` bands of `light`. Throws `Error` when `light` has fewer.
Light truncated(const Light& light, int order);

/// `light` turned about +Y by `angle` radians, counter-clockwise seen from above: light from +Z comes from +X
/// after a quarter turn.
Light rotated_about_y(const Light& light, double angle);

/// Scales the bands by a window. Hann and Lanczos use width `order`; `automatic` is the least diffusion over
/// the sphere, exp(-t l (l+1)), under which the radiance is nowhere negative, which may be none (the aim of
/// Sloan 2017, "Deringing Spherical Harmonics").
Light windowed(const Light& light, Window window);

} // namespace prt
