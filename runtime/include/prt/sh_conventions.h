#pragma once

// Lighting in the conventions of others. docs/conventions.md compares them. Stable.

#include "prt/light.h"

#include <array>
#include <span>

namespace prt {

/// To and from a basis without the Condon-Shortley phase: (-1)^m times each coefficient. [order²], in place.
void flip_condon_shortley(int order, std::span<float> coefficients);
void flip_condon_shortley(int order, std::span<double> coefficients);
void flip_condon_shortley(int order, std::span<glm::vec3> coefficients);

/// The nine coefficients of three.js's `SphericalHarmonics3`, as `LightProbe` takes them: radiance, no
/// Condon-Shortley phase. Throws `Error` for lighting of fewer than three bands.
std::array<glm::vec3, 9> to_three_js(const Light& light);
Light from_three_js(const std::array<glm::vec3, 9>& coefficients);

/// `irradianceCoefficients` of glTF's `EXT_lights_image_based`: irradiance instead of radiance, that is
/// convolved with the clamped cosine, no Condon-Shortley phase; in the order L00, L1-1, L10, L11, L2-2, ..
/// L22, which is also ours. Throws as `to_three_js`.
std::array<glm::vec3, 9> to_gltf_irradiance(const Light& light);
/// Three bands of radiance; what the convolution has left of them is divided by it again.
Light from_gltf_irradiance(const std::array<glm::vec3, 9>& coefficients);

/// D3DX's lights, to its numbers (docs/conventions.md). `D3DXSHEvalDirectionalLight`: a receiver of albedo 1
/// that faces it has exit radiance `intensity`, of the bands that there are.
Light d3dx_directional_light(int order, const glm::vec3& towards, const glm::vec3& intensity);
/// `D3DXSHEvalConeLight`: radiance intensity / sin²(min(half_angle, pi/2)), with which a receiver of albedo 1
/// that faces it would have exit radiance `intensity` if all bands were there. Throws as `cone_light` does,
/// and for a half angle of 0.
Light d3dx_cone_light(int order, const glm::vec3& axis, double half_angle, const glm::vec3& intensity);
/// `D3DXSHEvalHemisphereLight`: 3/2 of the radiance of `hemisphere_light`.
Light d3dx_hemisphere_light(int order, const glm::vec3& up, const glm::vec3& top, const glm::vec3& bottom);

} // namespace prt
