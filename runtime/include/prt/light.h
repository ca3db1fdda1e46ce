#pragma once

// Lighting as SH coefficients: L_c[i] = ∫ L_c(w) Y_i(w) dw, with L_c(w) the radiance of channel c that
// arrives from direction w. Colors are linear Rec. 709; radiance and irradiance have any unit that is
// consistent, and +Y is up. Stable.

#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Distant lighting as SH coefficients of its radiance. Unless stated otherwise, functions that create or
/// change a light return finite coefficients, or throw `Error`: for a color, direction or angle that is not
/// finite, for a direction of length 0, and for results that overflow a float. Functions that create a light
/// also throw `Error` for an order outside 1..kMaxOrder.
struct Light {
    int order = 0;                       ///< number of bands, 1..kMaxOrder; 0: empty, no light
    std::vector<glm::vec3> coefficients; ///< [order²] of RGB
};

/// Filter that scales each band of a lighting to reduce ringing, the oscillation that truncation to `order`
/// bands causes. The function `windowed` applies the filter.
enum class Window {
    none,     ///< no change
    hann,     ///< factor (1 + cos(pi l / order)) / 2 for band l
    lanczos,  ///< factor sin(pi l / order) / (pi l / order) for band l, 1 for band 0
    automatic ///< the weakest filter that leaves no negative radiance: `deringed` of prt/dering.h
};

/// Returns light of radiance `radiance` from every direction, in `order` bands.
Light constant_light(int order, const glm::vec3& radiance);

/// Returns a distant point-like light, in `order` bands. `towards` is the unit direction from receivers to
/// the light. `irradiance` is the irradiance on a receiver whose normal is `towards`, for an infinite number
/// of bands; `order` bands approximate it.
Light directional_light(int order, const glm::vec3& towards, const glm::vec3& irradiance);

/// Returns light of radiance `radiance` from all directions within `half_angle` radians of the unit direction
/// `axis`, and 0 from all others, in `order` bands. Coefficients are exact to rounding for any half angle in
/// 0..pi (docs/math.md, eq. 12). Throws `Error` for another half angle.
Light cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& radiance);

/// Returns light whose radiance is linear in the cosine of the angle to the unit direction `up`: `top` from
/// `up`, `bottom` from -`up`, and the mean of `top` and `bottom` from the horizon, in `order` bands.
/// D3DXSHEvalHemisphereLight returns 3/2 of this light: `d3dx_hemisphere_light` of prt/sh_conventions.h.
Light hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

/// Returns the light that a receiver at the origin sees of a sphere of radiance `radiance`, in `order` bands:
/// a cone of half angle asin(radius / |center|) about `center`, like D3DXSHEvalSphericalLight. `center` and
/// `radius` have the same unit. Throws `Error` if `radius` is not positive or not less than |center|.
Light sphere_light(int order, const glm::vec3& center, double radius, const glm::vec3& radiance);

/// Returns the light that a receiver at the origin sees of a disc of radiance `radiance`, in `order` bands.
/// The disc emits only to the side of its unit normal `normal`: the light is black if the origin is behind
/// the disc or in its plane. `center` and `radius` have the same unit. Coefficients are exact to rounding,
/// even close to the rim (docs/math.md, eq. 13). A call takes 0.1 to 1 ms. Throws `Error` if `radius` is not
/// positive, if `normal` is 0, and for arguments that are not finite; does not check `radiance` if the light
/// is black for this position.
Light disc_light(int order, const glm::vec3& center, const glm::vec3& normal, double radius,
                 const glm::vec3& radiance);

/// Returns the CIE overcast sky over black ground, in `order` bands. The radiance from a direction with the
/// vertical component y (up is +Y) is `zenith` (1 + 2 y) / 3 for y >= 0, else 0.
Light overcast_sky(int order, const glm::vec3& zenith);

/// Returns `light` with each channel scaled so that an unoccluded receiver with unit normal `normal` and
/// albedo 1 has exit radiance `exit_radiance`. D3DX scales directional lights this way, with the normal
/// towards the light. Throws `Error` if the exit radiance of that receiver under `light` is not positive in
/// every channel.
Light scaled_to_exit_radiance(const Light& light, const glm::vec3& normal, const glm::vec3& exit_radiance);

/// Returns the sum of the lights `a` and `b`. Throws `Error` if their orders differ.
Light sum(const Light& a, const Light& b);
/// Returns a + share (b - a): `a` for share 0, `b` for share 1. Serves for a transition between lightings
/// over many frames; other values of `share` extrapolate. Throws `Error` if the orders of `a` and `b` differ.
Light blended(const Light& a, const Light& b, float share);

/// Returns the radiance that arrives from unit direction `direction`: the sum of the coefficients times the
/// basis functions. The result can be negative, because truncated lighting rings. Does not throw.
glm::vec3 radiance(const Light& light, const glm::vec3& direction);

/// Returns the first `order` bands of `light`; `order` must be at least 1. Throws `Error` if `light` has
/// fewer bands.
Light truncated(const Light& light, int order);

/// Returns `light` rotated about +Y by `angle` radians, counter-clockwise seen from above. For example, pi/2
/// moves light that arrives from +Z so that it arrives from +X. Throws `Error` if `light` is empty (order 0).
Light rotated_about_y(const Light& light, double angle);

/// Returns `light` with each band multiplied by the factor that `window` defines for the order of the light.
/// For `Window::automatic`, `light` must have at least one band; throws the errors of `deringed`. For
/// `Window::none`, returns `light` without a check.
Light windowed(const Light& light, Window window);

} // namespace prt
