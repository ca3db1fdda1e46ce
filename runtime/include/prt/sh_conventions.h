#pragma once

// Lighting in the conventions of others. docs/conventions.md compares them.

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

} // namespace prt
