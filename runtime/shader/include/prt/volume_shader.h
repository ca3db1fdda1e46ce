#pragma once

// The shaders of volumes as source text. Experimental.

#include "prt/shader_source.h"
#include "prt/volume_relighter.h"

#include <string>

namespace prt {

/// Returns the define lines that shaders/prt_volume.glsl needs for a volume, with all sizes as constants.
/// `seen_from` 0: the shader gets positions as in the Scene; `seen_from` = Scene::origin: positions in the
/// file's world. The light sampler must clamp; with VolumeFormat::rgba16 it must also filter linearly.
std::string volume_defines(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                           const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the lookup functions for shaders of every language. Insert them after the version line (in ES also
/// after `precision highp float`).
std::string volume_functions(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete compute shader that computes the light texture (shaders/prt_volume.comp), for GLSL 4.5
/// and Vulkan, with constants in storage buffers. Throws `Error` for other languages, and for weights of more
/// words than shaders support.
std::string volume_shader(const CompressedVolume& volume, ShaderLanguage language,
                          VolumeFormat format = VolumeFormat::rgba16);

} // namespace prt
