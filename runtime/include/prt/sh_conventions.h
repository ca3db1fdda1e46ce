#pragma once

// Conversion of SH lighting between the conventions of prtkit and those of three.js, glTF and D3DX
// (docs/conventions.md). Colors are linear Rec. 709. Functions are thread-safe. Stable.

#include "prt/light.h"

#include <array>
#include <span>

namespace prt {

/// Multiplies each of the `coefficients` [order²] of degree m by (-1)^m, in place. This converts them from a
/// basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or back.
void flip_condon_shortley(int order, std::span<float> coefficients);
/// Multiplies each of the `coefficients` [order²] of degree m by (-1)^m, in place. This converts them from a
/// basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or back.
void flip_condon_shortley(int order, std::span<double> coefficients);
/// Multiplies each of the RGB `coefficients` [order²] of degree m by (-1)^m, in place. This converts them
/// from a basis with the Condon-Shortley phase, which prtkit uses, to a basis without it, or back.
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
/// Returns the light of D3DX's `D3DXSHEvalHemisphereLight`, which is 3/2 times `hemisphere_light` of
/// prt/light.h: its radiance changes linearly in the cosine to the unit direction `up`, from 3/2 `bottom`
/// below to 3/2 `top` above. Throws `Error` for an invalid order, a direction of length 0, arguments that are
/// not finite, and results that overflow a float.
Light d3dx_hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

} // namespace prt
