// Reports materials that our model of light does not fully support.

#include "scene/material_notices.h"

#include <fmt/core.h>

#include <set>

namespace prt {

std::vector<std::string> material_notices(const Scene& scene, bool with_bounces) {
    std::set<std::size_t> used;
    for (const Primitive& primitive : scene.primitives)
        used.insert(primitive.material);
    int polished = 0, tinted = 0;
    for (const std::size_t index : used) {
        const Material& m = scene.materials[index];
        polished += m.metal.factor > 0 && (m.metal.roughness < 1 || m.metal.texture.image >= 0);
        const glm::vec4& c = m.base_color;
        tinted += m.glass.factor > 0 && (c.r != c.g || c.g != c.b || m.base_color_texture.image >= 0);
    }
    std::vector<std::string> notices;
    if (polished > 0 && with_bounces)
        notices.push_back(fmt::format("{} of metal: what they reflect is in the bounces as far as they are "
                                      "rough, and lost as far as they are mirrors",
                                      polished == 1 ? "1 material" : fmt::format("{} materials", polished)));
    if (tinted > 0)
        notices.push_back(
            fmt::format("{} of tinted glass: the light that passes is dimmed by the luminance of "
                        "the base colour factor, and keeps its colour",
                        tinted == 1 ? "1 material" : fmt::format("{} materials", tinted)));
    return notices;
}

} // namespace prt
