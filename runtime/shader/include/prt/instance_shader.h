#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// Weights of a vertex that are not packed, at most: attributes of instances stand where those of more would.
inline constexpr int kMostInstancedWeights = 24;

/// The lines that `prt_instances.glsl` wants for a model: `relight_defines` and one more. Throws `Error` for
/// uniform blocks, and for weights that leave no attributes to instances.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ConstantSource constants = ConstantSource::buffer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// A complete vertex shader (shaders/prt_instances.vert). Throws `Error` as `instance_defines`.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

} // namespace prt
