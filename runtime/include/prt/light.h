#pragma once

// Lighting as SH coefficients: L_c[i] = ∫ L_c(w) Y_i(w) dw, colors linear Rec. 709. Stable.

#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Every function that makes or changes one gives finite coefficients or throws `Error`: for a color, a
/// direction or an angle that is not finite, and where floats do not hold what a color comes to.
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
/// zero outside, exact for cones as narrow as can be: docs/math.md, eq. 12. Throws `Error` for another half
/// angle.
Light cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& radiance);

/// Radiance that goes over from `bottom` to `top` with the cosine to the unit direction `up`: their mean on
/// the horizon. D3DXSHEvalHemisphereLight is 3/2 of it: `d3dx_hemisphere_light` of prt/sh_conventions.h.
Light hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

/// A sphere of radiance `radiance` about `center`, seen from the origin: the cone that it fills, of half
/// angle asin(radius / distance) (D3DXSHEvalSphericalLight). Throws `Error` where the origin is inside it.
Light sphere_light(int order, const glm::vec3& center, double radius, const glm::vec3& radiance);

/// A disc about `center` that shines to the side of its unit normal `normal`, seen from the origin; nothing
/// from behind or edge on. Exact to rounding wherever the origin is, next to the rim and in the disc's plane,
/// too, at some 0.1 to 1 ms (docs/math.md, eq. 13). Throws `Error` for a radius that is not positive and for
/// what is not finite.
Light disc_light(int order, const glm::vec3& center, const glm::vec3& normal, double radius,
                 const glm::vec3& radiance);

/// The CIE overcast sky about +Y over black ground: radiance `zenith` (1 + 2 y) / 3 for y >= 0.
Light overcast_sky(int order, const glm::vec3& zenith);

/// `light` scaled so that an open receiver of albedo 1 with unit normal `normal` has exit radiance
/// `exit_radiance`: D3DX scales directional lights so, for the receiver that faces them. Throws `Error` where
/// `light` leaves a channel of that receiver black.
Light scaled_to_exit_radiance(const Light& light, const glm::vec3& normal, const glm::vec3& exit_radiance);

/// a + b, of one order. Throws `Error` for two.
Light sum(const Light& a, const Light& b);
/// a + share (b - a): from one lighting to another over many frames. Throws `Error` for two orders.
Light blended(const Light& a, const Light& b, float share);

/// The radiance of the SH expansion in unit direction `direction`.
glm::vec3 radiance(const Light& light, const glm::vec3& direction);

/// The first `order` bands of `light`. Throws `Error` when `light` has fewer.
Light truncated(const Light& light, int order);

/// `light` turned about +Y by `angle` radians, counter-clockwise seen from above: light from +Z comes from +X
/// after a quarter turn.
Light rotated_about_y(const Light& light, double angle);

/// Scales the bands by a window. Hann and Lanczos use width `order`; `automatic` is the least filter under
/// which the radiance is nowhere negative, which may be none: `deringed` of prt/dering.h.
Light windowed(const Light& light, Window window);

} // namespace prt
