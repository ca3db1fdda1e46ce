// Builds the shaders of instances that share transfer.
#include "prt/shader/shader_source.h"

#include "prt/core/error.h"

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

} // namespace prt
