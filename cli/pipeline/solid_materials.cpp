// Finds materials that are lit through a medium.

#include "cli/pipeline/solid_materials.h"

#include "prt/bake/bake_options.h"
#include "prt/core/error.h"

#include <algorithm>

namespace prt::pipeline {
namespace {

/// Materials that are in use and of which no vertex has direct light.
std::vector<bool> without_direct_light(const Scene& scene, const Transfer& transfer) {
    const std::size_t count = transfer.layout.numbers_of(transfer.layout.terms.front());
    std::vector<bool> used(scene.materials.size(), false), lit = used;
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner) {
                const std::size_t p = scene.vertex_arrays[primitive.vertices].first_receiver + t[corner];
                const auto direct = transfer.vector(p).first(count);
                used[primitive.material] = true;
                if (std::any_of(direct.begin(), direct.end(), [](float v) { return v != 0; }))
                    lit[primitive.material] = true;
            }
    for (std::size_t m = 0; m < used.size(); ++m)
        used[m] = used[m] && !lit[m];
    return used;
}

} // namespace

std::vector<bool> solid_materials(const SceneFile& model) {
    const Scene& scene = model.scene;
    const bool direct = !model.record() || !layout_of(model).has(TermKind::indirect) ||
                        layout_of(model).has(TermKind::direct);
    std::vector<bool> solid(scene.materials.size(),
                            !direct); // all of it, where there is indirect light alone
    if (direct && model.baked && !model.lightmap && model.baked->transfer.layout.has(TermKind::direct))
        solid = without_direct_light(scene, model.baked->transfer);
    for (std::size_t m = 0; m < solid.size(); ++m)
        solid[m] = solid[m] || medium_of(scene.materials[m]);
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
