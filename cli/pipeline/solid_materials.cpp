// Finds materials that are lit through a medium.

#include "cli/pipeline/solid_materials.h"

#include "prt/core/error.h"
#include "runtime/load/light_passing.h"

namespace prt::pipeline {

std::vector<bool> solid_materials(const Scene& scene) {
    std::vector<bool> solid;
    for (const Material& material : scene.materials)
        solid.push_back(lit_through_medium(material));
    return solid;
}

void check_no_media(const Scene& scene, const std::vector<bool>& solid) {
    for (const Primitive& primitive : scene.primitives)
        if (solid[primitive.material])
            throw Error("material '" + scene.materials[primitive.material].name +
                        "' has no direct light: its light passes through a medium, which the path tracer of "
                        "an error budget does not support, or no light reaches it");
}

} // namespace prt::pipeline
