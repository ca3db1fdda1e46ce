#pragma once

// Conversion of lighting to and from the conventions of other software. docs/conventions.md compares them.
// Stable.

#include "prt/light.h"

#include <array>
#include <span>

namespace prt {

/// Converts to or from a basis without the Condon-Shortley phase: multiplies each coefficient by (-1)^m.
/// [order²], in place.
void flip_condon_shortley(int order, std::span<float> coefficients);
void flip_condon_shortley(int order, std::span<double> coefficients);
void flip_condon_shortley(int order, std::span<glm::vec3> coefficients);

/// Returns the nine coefficients of three.js's `SphericalHarmonics3` for `LightProbe`: radiance, no
/// Condon-Shortley phase. Throws `Error` for lighting of fewer than three bands.
std::array<glm::vec3, 9> to_three_js(const Light& light);
/// Returns three bands of lighting from the coefficients of three.js.
Light from_three_js(const std::array<glm::vec3, 9>& coefficients);

/// Returns `irradianceCoefficients` of glTF's `EXT_lights_image_based`: irradiance instead of radiance
/// (convolved with the clamped cosine), no Condon-Shortley phase, in the order L00, L1-1, L10, L11, L2-2, ..
/// L22, which is also the order of prtkit. Throws `Error` for lighting of fewer than three bands.
std::array<glm::vec3, 9> to_gltf_irradiance(const Light& light);
/// Returns three bands of lighting from the irradiance coefficients of glTF, by division by the convolution
/// factors.
Light from_gltf_irradiance(const std::array<glm::vec3, 9>& coefficients);

/// Returns the light of D3DX's `D3DXSHEvalDirectionalLight`, with its scale (docs/conventions.md): a receiver
/// of albedo 1 that faces the light has exit radiance `intensity`, evaluated with `order` bands.
Light d3dx_directional_light(int order, const glm::vec3& towards, const glm::vec3& intensity);
/// Returns the light of D3DX's `D3DXSHEvalConeLight`: radiance intensity / sin²(min(half_angle, pi/2)). With
/// all bands, a receiver of albedo 1 that faces the light would have exit radiance `intensity`. Throws the
/// errors of `cone_light`, and `Error` for a half angle of 0.
Light d3dx_cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& intensity);
/// Returns the light of D3DX's `D3DXSHEvalHemisphereLight`: 3/2 of the radiance of `hemisphere_light`.
Light d3dx_hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

} // namespace prt
