#pragma once

// The shaders of volumes as source text. Experimental.

#include "prt/shader_source.h"
#include "prt/volume_relighter.h"

#include <string>

namespace prt {

/// Returns the lines of #define for shaders/prt_volume.glsl, with all sizes of `volume` as constants.
/// `format`: format of the light texture. Its sampler must clamp; for VolumeFormat::rgba16 it must also
/// filter linearly. The shader gets the positions of the Scene plus `seen_from`. `seen_from` 0: positions
/// relative to Scene::origin. `seen_from` = Scene::origin: positions in the file's world. `volume` must have
/// at least one brick.
std::string volume_defines(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                           const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns the GLSL functions that look up the light of a volume at a position (shaders/prt_volume.glsl), the
/// same for every language. Insert them after the version line of a shader, in ES after
/// `precision highp float`. The arguments are those of `volume_defines`.
std::string volume_functions(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16,
                             const glm::dvec3& seen_from = glm::dvec3(0));

/// Returns a complete compute shader that computes the light texture, in `format`, from constants
/// (VolumeRelighter::update_constants) in storage buffers, as VolumeRelighter::update does on the CPU
/// (shaders/prt_volume.comp). Throws `Error` for OpenGL 3.3 and ES 3.0, and for packed weights of more than 8
/// words per probe. `volume` must have packed weights.
std::string volume_shader(const CompressedVolume& volume, ShaderLanguage language,
                          VolumeFormat format = VolumeFormat::rgba16);

} // namespace prt
