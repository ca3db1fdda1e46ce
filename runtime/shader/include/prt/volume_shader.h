#pragma once

// The shaders of volumes as text. Experimental.

#include "prt/shader_source.h"
#include "prt/volume_former.h"

#include <string>

namespace prt {

/// The lines that shaders/prt_volume.glsl wants for a volume, all as numbers. The shader is given positions
/// as the Scene has them where `seen_from` is 0, and in the file's world where it is Scene::origin. Of
/// rgba16 the sampler of light has to filter linearly; it clamps either way.
std::string volume_defines(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                           const glm::dvec3& seen_from = glm::dvec3(0));

/// The lookup for shaders of every language, to be put behind their version line (of ES: and `precision highp
/// float`).
std::string volume_functions(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// A complete compute shader that forms the texture of light (shaders/prt_volume.comp), for GLSL 4.5 and
/// Vulkan, with constants in storage buffers. Throws `Error` for other languages, and for weights of more
/// words than shaders take.
std::string volume_shader(const CompressedVolume& volume, ShaderLanguage language,
                          VolumeFormat format = VolumeFormat::rgba16);

} // namespace prt
