// Builds the shaders of lobes.
#include "prt/shader/shader_source.h"

#include "prt/core/error.h"
#include "runtime/shader/defines.h"

namespace prt {

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

} // namespace prt
