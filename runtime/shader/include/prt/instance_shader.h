#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// Maximum number of unpacked (float) weights per vertex of a mesh that is drawn as instances. More weights
/// would need the attribute locations of the instance data.
inline constexpr int kMaxInstancedWeights = 24;

/// Returns the lines of #define for shaders/prt_instances.glsl: those of `relight_defines` for the same
/// arguments, and PRT_INSTANCES. `seen_from` 0: the shader gets positions relative to the origin of
/// InstancedModel::stored. `seen_from` = this origin: the shader gets positions in the mesh's frame, as in
/// the file. `relit_instances` must get the same `seen_from`. Throws the errors of `relight_defines`, and
/// `Error` for ConstantSource::block and for more than kMaxInstancedWeights unpacked weights.
std::string instance_defines(const ClusteredTransfer& transfer,
                             ConstantSource constants = ConstantSource::buffer,
                             ShaderLanguage language = ShaderLanguage::glsl450,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete vertex shader for the instances of a model (shaders/prt_instances.vert); its output is
/// the exit radiance for albedo 1. The arguments are those of `instance_defines`. Throws the errors of
/// `instance_defines`.
std::string instance_shader(const ClusteredTransfer& transfer,
                            ConstantSource constants = ConstantSource::buffer,
                            ShaderLanguage language = ShaderLanguage::glsl450,
                            const glm::dvec3& seen_from = glm::dvec3(0));

} // namespace prt
