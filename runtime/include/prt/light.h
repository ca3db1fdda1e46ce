#pragma once

// Lighting as SH coefficients: L_c[i] = ∫ L_c(w) Y_i(w) dw, colors linear Rec. 709. Stable.

#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// SH lighting. Every function that creates or changes a light returns finite coefficients, or throws
/// `Error`: for a color, direction or angle that is not finite, and for results that overflow a float.
struct Light {
    int order = 0;
    std::vector<glm::vec3> coefficients; ///< [order²] of RGB
};

/// Filter that scales the bands of a lighting to reduce ringing: `windowed`.
enum class Window { none, hann, lanczos, automatic };

/// Returns light of radiance `radiance` from every direction.
Light constant_light(int order, const glm::vec3& radiance);

/// Returns a distant light with irradiance `irradiance` on a receiver that faces it. `towards` is the unit
/// direction from the receiver to the light.
Light directional_light(int order, const glm::vec3& towards, const glm::vec3& irradiance);

/// Returns light of radiance `radiance` inside the cone of half angle `half_angle` (radians, at most pi)
/// about unit `axis`, and zero outside. The result is exact for arbitrarily narrow cones: docs/math.md, eq.
/// 12. Throws `Error` for an invalid half angle.
Light cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& radiance);

/// Returns light whose radiance changes from `bottom` to `top` linearly in the cosine to the unit direction
/// `up`; on the horizon it is their mean. D3DXSHEvalHemisphereLight is 3/2 of it: `d3dx_hemisphere_light` of
/// prt/sh_conventions.h.
Light hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

/// Returns the light of a sphere of radiance `radiance` at `center`, seen from the origin: a cone of half
/// angle asin(radius / distance) (D3DXSHEvalSphericalLight). Throws `Error` if the origin is inside the
/// sphere.
Light sphere_light(int order, const glm::vec3& center, double radius, const glm::vec3& radiance);

/// Returns the light of a disc at `center` that emits to the side of its unit normal `normal`, seen from the
/// origin. It is black from behind and edge-on. Exact to rounding for every position of the origin, also near
/// the rim and in the plane of the disc; takes 0.1 to 1 ms (docs/math.md, eq. 13). Throws `Error` for a
/// radius that is not positive and for arguments that are not finite.
Light disc_light(int order, const glm::vec3& center, const glm::vec3& normal, double radius,
                 const glm::vec3& radiance);

/// Returns the CIE overcast sky about +Y over black ground: radiance `zenith` (1 + 2 y) / 3 for y >= 0.
Light overcast_sky(int order, const glm::vec3& zenith);

/// Returns `light` scaled so that an unoccluded receiver of albedo 1 with unit normal `normal` has exit
/// radiance `exit_radiance`. D3DX scales directional lights this way, for the receiver that faces them.
/// Throws `Error` if a channel of that receiver is black under `light`.
Light scaled_to_exit_radiance(const Light& light, const glm::vec3& normal, const glm::vec3& exit_radiance);

/// Returns a + b. Throws `Error` if the orders differ.
Light sum(const Light& a, const Light& b);
/// Returns a + share (b - a), for a transition between lightings over many frames. Throws `Error` if the
/// orders differ.
Light blended(const Light& a, const Light& b, float share);

/// Returns the radiance of the SH expansion in unit direction `direction`.
glm::vec3 radiance(const Light& light, const glm::vec3& direction);

/// Returns the first `order` bands of `light`. Throws `Error` if `light` has fewer.
Light truncated(const Light& light, int order);

/// Returns `light` rotated about +Y by `angle` radians, counter-clockwise seen from above: a rotation by pi/2
/// moves light from +Z to +X.
Light rotated_about_y(const Light& light, double angle);

/// Returns `light` with its bands scaled by a window. Hann and Lanczos use width `order`. `automatic` is the
/// weakest filter that makes the radiance non-negative everywhere, possibly none: `deringed` of prt/dering.h.
Light windowed(const Light& light, Window window);

} // namespace prt
