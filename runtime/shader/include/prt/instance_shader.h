#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// Maximum number of unpacked weights of a vertex. The attributes of instances use the locations of further
/// weights.
inline constexpr int kMaxInstancedWeights = 24;

/// Returns the define lines that shaders/prt_instances.glsl needs for a model: those of `relight_defines` and
/// one more. Throws `Error` for uniform blocks, and for weights that leave no attributes for instances.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ConstantSource constants = ConstantSource::buffer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader for the instances of a model (shaders/prt_instances.vert). Throws the
/// errors of `instance_defines`.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

} // namespace prt
