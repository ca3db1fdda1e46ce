#pragma once

// Lighting as SH coefficients: L_c[i] = ∫ L_c(w) Y_i(w) dw, with L_c(w) the radiance of channel c that
// arrives from direction w. Colors are linear Rec. 709; radiance and irradiance have any unit that is
// consistent, and +Y is up. Also suns, skies (A. Preetham, P. Shirley and B. Smits, "A Practical Analytic
// Model for Daylight", SIGGRAPH 1999), and conversions to other libraries (docs/conventions.md). Stable.

#include "prt/core/glm_layout.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Luminance weights of linear Rec. 709 red, green and blue; their sum is 1.
inline constexpr glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722);

/// Returns the luminance of a linear Rec. 709 color, in the unit of the color: the luminance of (v, v, v) is
/// v.
template <class Real>
Real luminance(const glm::vec<3, Real>& rgb) {
    return glm::dot(rgb, glm::vec<3, Real>(kLuminance));
}

/// Returns whether red, green and blue are exactly equal.
inline bool is_grey(const glm::vec3& rgb) {
    return rgb.r == rgb.g && rgb.g == rgb.b;
}

/// Distant lighting as SH coefficients of its radiance. Unless stated otherwise, functions that create or
/// change a light return finite coefficients, or throw `Error`: for a color, direction or angle that is not
/// finite, for a direction of length 0, and for results that overflow a float. Functions that create a light
/// also throw `Error` for an order outside 1..kMaxOrder.
struct Light {
    int order = 0;                       ///< number of bands, 1..kMaxOrder; 0: empty, no light
    std::vector<glm::vec3> coefficients; ///< [order²] of RGB
};

/// A sun: a distant disc of uniform radiance, or a directional light if `half_angle` is 0.
struct Sun {
    glm::vec3 towards = {0, 1, 0}; ///< unit direction from the receiver to the center of the disc
    /// Irradiance on a receiver that faces the center of the disc: linear Rec. 709, in the unit of the sky's
    /// radiance times sr. An unoccluded receiver of albedo 1 then has the exit radiance irradiance / pi.
    glm::vec3 irradiance{0};
    double half_angle = 0; ///< angle from the center of the disc to its rim, radians, 0..pi/2
};

/// Returns `sun` as SH radiance coefficients of `order` bands (docs/math.md, eq. 14), for example for
/// `Lighting::suns`. Throws `Error` for an order outside 1..kMaxOrder, a half angle outside 0..pi/2, a
/// direction of length 0, values that are not finite, and coefficients that overflow a float.
Light as_light(const Sun& sun, int order);
/// Returns the sum of all `suns` as SH radiance coefficients of `order` bands, for example for
/// `Lighting::suns`; all coefficients are 0 if `suns` is empty. Throws `Error` for an order outside
/// 1..kMaxOrder, for a sun that the other overload rejects, and for a sum that overflows a float.
Light as_light(std::span<const Sun> suns, int order);

/// Filter that scales each band of a lighting to reduce ringing, the oscillation that truncation to `order`
/// bands causes. The function `windowed` applies the filter.
enum class Window {
    none,     ///< no change
    hann,     ///< factor (1 + cos(pi l / order)) / 2 for band l
    lanczos,  ///< factor sin(pi l / order) / (pi l / order) for band l, 1 for band 0
    automatic ///< the weakest filter that leaves no negative radiance: `deringed` of prt/core/dering.h
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
/// D3DXSHEvalHemisphereLight returns 3/2 of this light: `d3dx_hemisphere_light`.
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

/// The light of the sky without the disc of the sun. +Y is up. Radiance is linear Rec. 709 and scaled so that
/// its luminance is in kcd/m², the unit of the model; callers multiply it by their exposure. Immutable and
/// thread-safe.
class PreethamSky {
public:
    /// `turbidity` measures the haze: 2 is a clear sky, 10 is hazy. The model was fitted for 2 to 10. `sun`
    /// is the unit direction to the sun. Throws `Error` unless turbidity is in 1.7..10, sun.y >= 0 and the
    /// length of `sun` is 1 within 0.001.
    PreethamSky(double turbidity, const glm::dvec3& sun);

    /// Returns the radiance from unit direction `direction`: linear Rec. 709, luminance in kcd/m². Channels
    /// that would be negative are 0. Returns black for direction.y <= 0. For 0 < direction.y < 0.01 the model
    /// uses 0.01 for the height above the horizon.
    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// Luminance of the sky in direction +Y, in kcd/m².
    double zenith_luminance() const { return zenith_luminance_; }

private:
    /// The five parameters A to E of the sky distribution of Perez et al. (1993), from the formulas of
    /// Preetham et al., appendix A.2.
    using Perez = std::array<double, 5>;

    glm::dvec3 sun_;          ///< unit direction to the sun
    Perez luminance_, x_, y_; ///< distributions of the luminance and of the CIE chromaticities x and y
    double zenith_luminance_; ///< kcd/m²
    /// Luminance (kcd/m²) and CIE chromaticities x and y of the zenith, each divided by the value of its
    /// distribution at the zenith.
    double luminance_over_perez_, x_over_perez_, y_over_perez_;
};

/// Returns the radiance of `sky` as SH coefficients of `order` bands, in the unit of `PreethamSky::radiance`.
/// The result contains neither the sun nor light from the ground; callers can add both with `sum`,
/// for example a `cone_light`. Throws `Error` for an order outside 1..kMaxOrder.
Light sky_light(int order, const PreethamSky& sky);

/// Multiplies each of the `coefficients` [order²], (l, m) at index l(l+1) + m, by (-1)^m, in place. This
/// converts them from a basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or
/// back.
void flip_condon_shortley(int order, std::span<float> coefficients);
/// Multiplies each of the `coefficients` [order²], (l, m) at index l(l+1) + m, by (-1)^m, in place. This
/// converts them from a basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or
/// back.
void flip_condon_shortley(int order, std::span<double> coefficients);
/// Multiplies each of the RGB `coefficients` [order²], (l, m) at index l(l+1) + m, by (-1)^m, in place. This
/// converts them from a basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or
/// back.
void flip_condon_shortley(int order, std::span<glm::vec3> coefficients);

/// Returns the first three bands of `light` as the nine coefficients of three.js's `SphericalHarmonics3`, for
/// its `LightProbe`. They represent radiance, in a basis without the Condon-Shortley phase, at index l(l+1) +
/// m. Throws `Error` if `light` has fewer than three bands, or if one of the nine coefficients is not finite.
std::array<glm::vec3, 9> to_three_js(const Light& light);
/// Returns light of order 3 from the nine coefficients of three.js's `SphericalHarmonics3`, which represent
/// radiance; the inverse of `to_three_js`. Throws `Error` if a coefficient is not finite.
Light from_three_js(const std::array<glm::vec3, 9>& coefficients);

/// Returns the first three bands of `light` as `irradianceCoefficients` of glTF's `EXT_lights_image_based`.
/// They represent irradiance, which is radiance convolved with the clamped cosine (factors pi, 2 pi / 3 and
/// pi / 4 for bands 0, 1 and 2), in a basis without the Condon-Shortley phase. Their sequence L00, L1-1, L10,
/// L11, L2-2, .. L22 equals that of prtkit. Throws `Error` if `light` has fewer than three bands, or if a
/// result is not finite.
std::array<glm::vec3, 9> to_gltf_irradiance(const Light& light);
/// Returns light of order 3 from the nine `irradianceCoefficients` of glTF's `EXT_lights_image_based`; the
/// inverse of `to_gltf_irradiance`. Throws `Error` if a coefficient is not finite, or if a result overflows a
/// float.
Light from_gltf_irradiance(const std::array<glm::vec3, 9>& coefficients);

/// Returns the light of D3DX's `D3DXSHEvalDirectionalLight`, with the scale of D3DX (docs/conventions.md): an
/// unoccluded receiver of albedo 1 that faces the light has the exit radiance `intensity`, computed with
/// `order` bands. `towards` is the unit direction from the receiver to the light. Throws `Error` for an
/// invalid order, a direction of length 0, arguments that are not finite, and results that overflow a float.
Light d3dx_directional_light(int order, const glm::vec3& towards, const glm::vec3& intensity);
/// Returns the light of D3DX's `D3DXSHEvalConeLight`: radiance intensity / sin²(min(half_angle, pi/2)) inside
/// the cone, 0 outside. `axis` is the unit direction from the receiver to the center of the light, and
/// `half_angle` is in radians. With infinitely many bands, a receiver of albedo 1 that faces the light would
/// have the exit radiance `intensity`. Throws `Error` unless 0 < half_angle <= pi (pi as a float is valid),
/// and for an invalid order, an axis of length 0, arguments that are not finite, and results that overflow a
/// float.
Light d3dx_cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& intensity);
/// Returns the light of D3DX's `D3DXSHEvalHemisphereLight`, which is 3/2 times `hemisphere_light`:
/// its radiance changes linearly in the cosine to the unit direction `up`, from 3/2
/// `bottom` below to 3/2 `top` above. Throws `Error` for an invalid order, a direction of length 0, arguments
/// that are not finite, and results that overflow a float.
Light d3dx_hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

} // namespace prt
