#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// The lines that `prt_instances.glsl` wants for a model: `relight_defines`, and the rows of a lighting's
/// constants.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// A complete vertex shader (shaders/prt_instances.vert), for languages with storage buffers. Throws `Error`
/// for others.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

} // namespace prt
