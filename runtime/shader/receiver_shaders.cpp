// Builds the shaders of instances, lobes and volumes.
#include "prt/shader/shader_source.h"

#include "prt/core/error.h"
#include "runtime/shader/defines.h"

#include <algorithm>

namespace prt {

std::string instance_defines(const ClusteredTransfer& transfer, ConstantSource constants,
                             ShaderLanguage language, const glm::dvec3& seen_from) {
    if (constants == ConstantSource::block)
        throw Error(
            "the constants of instances do not fit into a uniform block; use --constants buffer or texture");
    if (transfer.receivers.format != WeightFormat::packed &&
        std::ranges::max(transfer.bases.components) > kMaxInstancedWeights)
        throw Error("instances support at most 24 float weights per vertex; compress with fewer components "
                    "or --bits N");
    return relight_defines(transfer, constants, language, seen_from) + "#define PRT_INSTANCES\n";
}

std::string instance_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                            ShaderLanguage language, const glm::dvec3& seen_from) {
    return shader_source("prt_instances.vert", instance_defines(transfer, constants, language, seen_from),
                         language);
}

std::string lobe_defines(const LobeModel& model, int light_order) {
    check_lobes(model);
    const int order = light_order == 0 ? model.order : light_order;
    if (order < 2 || order > kMaxLobeOrder)
        throw Error("the order of the light for lobes must be in 2.." + std::to_string(kMaxLobeOrder) +
                    ", not " + std::to_string(order));
    return define("PRT_LOBES", model.lobes) + define("PRT_LOBE_ORDER", static_cast<std::size_t>(order));
}

std::string lobe_functions(const LobeModel& model, const std::string& behind) {
    check_lobes(model);
    const std::string defines = behind.empty() ? lobe_defines(model) : define("PRT_LOBES", model.lobes);
    return behind + shader_part("prt_lobes.glsl", defines);
}

std::vector<glm::vec4> lobe_profile_block(const LobeModel& model) {
    std::vector<glm::vec4> block(kMaxProfiles, glm::vec4(0));
    for (std::size_t p = 0; p < model.profiles.size(); ++p)
        for (std::size_t l = 0; l < kMaxLobeOrder; ++l)
            block[p][static_cast<int>(l)] = model.profiles[p][l];
    return block;
}

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
