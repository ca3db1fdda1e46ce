#include "prt/instance_shader.h"

#include "defines.h"

namespace prt {

std::string instance_defines(const ClusteredTransfer& transfer, ShaderLanguage language,
                             const glm::dvec3& seen_from) {
    return relight_defines(transfer, ConstantSource::buffer, language, seen_from) +
           define("PRT_INSTANCE_ROWS", constant_rows(transfer.bases));
}

std::string instance_shader(const ClusteredTransfer& transfer, ShaderLanguage language,
                            const glm::dvec3& seen_from) {
    return shader_source("prt_instances.vert", instance_defines(transfer, language, seen_from), language);
}

} // namespace prt
