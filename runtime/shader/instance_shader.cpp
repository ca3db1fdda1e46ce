// Builds the shaders of instances that share transfer.
#include "prt/instance_shader.h"

#include "prt/support/error.h"

#include <algorithm>

namespace prt {

std::string instance_defines(const ClusteredTransfer& transfer, ConstantSource constants,
                             ShaderLanguage language, const glm::dvec3& seen_from) {
    if (constants == ConstantSource::block)
        throw Error("constants of instances are more than a uniform block holds: use a buffer or a texture");
    if (transfer.receivers.format != WeightFormat::packed &&
        std::ranges::max(transfer.bases.components) > kMaxInstancedWeights)
        throw Error("instances have attributes where those of more than 24 weights would be");
    return relight_defines(transfer, constants, language, seen_from) + "#define PRT_INSTANCES\n";
}

std::string instance_shader(const ClusteredTransfer& transfer, ConstantSource constants,
                            ShaderLanguage language, const glm::dvec3& seen_from) {
    return shader_source("prt_instances.vert", instance_defines(transfer, constants, language, seen_from),
                         language);
}

} // namespace prt
