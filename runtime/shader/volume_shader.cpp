// Builds the lookup of volumes.
#include "prt/shader/shader_source.h"

#include "runtime/shader/defines.h"

namespace prt {

std::string volume_defines(const CompressedVolume& volume, TexelFormat format, const glm::dvec3& seen_from) {
    const VolumeGrid& grid = volume.grid;
    const VolumeBrick& first = grid.bricks.front();
    return define("PRT_VOLUME_ORDER", static_cast<std::size_t>(volume.order)) +
           (format == TexelFormat::rgba16 ? "#define PRT_VOLUME_LINEAR\n" : "") +
           define("PRT_VOLUME_ORIGIN", glsl_vector(seen_from + glm::dvec3(grid.origin))) +
           define("PRT_VOLUME_SPACING", glsl_number(static_cast<double>(grid.spacing))) +
           define("PRT_VOLUME_SIZE", glsl_vector(grid.size)) +
           define("PRT_VOLUME_FIRST",
                  "ivec4(" + glsl_vector(first.position) + ", " + std::to_string(first.level) + ")") +
           define("PRT_VOLUME_BRICKS", glsl_vector(atlas_of(grid, volume.order).bricks));
}

std::string volume_functions(const CompressedVolume& volume, TexelFormat format,
                             const glm::dvec3& seen_from) {
    return shader_part("prt_volume.glsl", volume_defines(volume, format, seen_from));
}

} // namespace prt
