#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// Maximum number of weights of a vertex that are not packed: attributes of instances use the locations of
/// further weights.
inline constexpr int kMaxInstancedWeights = 24;

/// Returns the define lines for `prt_instances.glsl` for a model: those of `relight_defines` and one more.
/// Throws `Error` for uniform blocks, and for weights that leave no attributes for instances.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ConstantSource constants = ConstantSource::buffer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader (shaders/prt_instances.vert). Throws `Error` as `instance_defines`.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

} // namespace prt
