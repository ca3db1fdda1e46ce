#pragma once

// The vertex shader of instances that share transfer. Experimental.

#include "prt/shader_source.h"

namespace prt {

/// Maximum number of unpacked (float) weights of a vertex whose mesh is drawn in instances. The attributes of
/// instances use the locations of further weights.
inline constexpr int kMaxInstancedWeights = 24;

/// Returns the lines of #define for shaders/prt_instances.glsl: those of `relight_defines` for the same
/// arguments, and PRT_INSTANCES. The shader gets positions in the frame of InstanceBox. `seen_from` 0: this
/// is the frame of InstancedModel::stored, as for `relit_instances`. `seen_from` = origin of this scene: the
/// frame of the mesh. Throws the errors of `relight_defines`, and `Error` for ConstantSource::block and for
/// more than kMaxInstancedWeights unpacked weights.
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
