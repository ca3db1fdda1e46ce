// Builds the shaders of volumes.
#include "prt/shader/shader_source.h"

#include "prt/core/error.h"
#include "runtime/shader/defines.h"

namespace prt {

std::string volume_defines(const CompressedVolume& volume, VolumeFormat format, const glm::dvec3& seen_from) {
    const VolumeGrid& grid = volume.grid;
    const VolumeBrick& first = grid.bricks.front();
    return define("PRT_VOLUME_ORDER", static_cast<std::size_t>(volume.order)) +
           (format == VolumeFormat::rgba16 ? "#define PRT_VOLUME_LINEAR\n" : "") +
           define("PRT_VOLUME_ORIGIN", glsl_vector(seen_from + glm::dvec3(grid.origin))) +
           define("PRT_VOLUME_SPACING", glsl_number(static_cast<double>(grid.spacing))) +
           define("PRT_VOLUME_SIZE", glsl_vector(grid.size)) +
           define("PRT_VOLUME_FIRST",
                  "ivec4(" + glsl_vector(first.position) + ", " + std::to_string(first.level) + ")") +
           define("PRT_VOLUME_BRICKS", glsl_vector(atlas_of(grid, volume.order).bricks));
}

std::string volume_functions(const CompressedVolume& volume, VolumeFormat format,
                             const glm::dvec3& seen_from) {
    return shader_part("prt_volume.glsl", volume_defines(volume, format, seen_from));
}

std::string volume_shader(const CompressedVolume& volume, ShaderLanguage language, VolumeFormat format) {
    if (language != ShaderLanguage::glsl450 && language != ShaderLanguage::vulkan)
        throw Error(
            "OpenGL 3.3 and OpenGL ES 3.0 do not support compute shaders; compute the texture on the CPU");
    return shader_source(
        "prt_volume.comp",
        relight_defines(volume.compressed.transfer, ConstantSource::buffer, language) +
            define("PRT_VOLUME_ORDER", static_cast<std::size_t>(volume.order)) +
            define("PRT_VOLUME_FORMAT", std::string(format == VolumeFormat::rgba16 ? "rgba16f" : "rgba32f")),
        language);
}

} // namespace prt
