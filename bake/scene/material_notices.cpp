// Reports materials that our model of light does not fully support.

#include "bake/scene/material_notices.h"

#include "runtime/core/support/counted.h"

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
        notices.push_back(fmt::format("{} metallic: bounces contain the rough part of the reflection, the "
                                      "mirror part is lost",
                                      counted(polished, "material is", "materials are")));
    if (tinted > 0)
        notices.push_back(fmt::format("{} tinted glass: transmitted light is multiplied by the luminance of "
                                      "the base color factor, without a change of hue",
                                      counted(tinted, "material is", "materials are")));
    return notices;
}

} // namespace prt
