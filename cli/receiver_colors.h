#pragma once

#include "inputs.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt::cli {

/// Exit radiance for albedo 1 of every receiver: compressed, baked, or unshadowed, whatever the model holds.
std::vector<glm::vec3> lit_colors(const Model& model, const Light& light, int threads);

/// Ambient occlusion: the exit radiance under uniform light of radiance 1.
std::vector<glm::vec3> ao_colors(const Model& model, int threads);

/// A colour per cluster. Throws `Error` when the model is not compressed.
std::vector<glm::vec3> cluster_colors(const Model& model);

/// Error of exit radiance against `baked`, which holds raw transfer and belongs to `model`: from black over
/// red and yellow to white, which is `kWhiteError` of the mean radiance.
inline constexpr double kWhiteError = 0.1;
std::vector<glm::vec3> error_colors(const Model& model, const Model& baked, const Light& light, int threads);

} // namespace prt::cli
