// Finds space for texels in texture coordinates, and loads high-poly models.

#include "cli/pipeline/texel_room.h"

#include "bake/products/lightmaps/unwrap.h"
#include "bake/reference/scene_lamps.h"
#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace prt::pipeline {
namespace {

/// Generates new texture coordinates for the scene.
TexelRoom unwrapped(const TexelRequest& a, const Path& path, GltfDocument& document, Scene& scene,
                    const Notify& notify) {
    Unwrapping unwrapping = unwrap(scene, a.texels);
    const int set = free_texcoord(scene);
    document = with_texcoords(std::move(document), scene, unwrapping.primitives, set);
    scene = extract_scene(document);
    for (Atlas& atlas : unwrapping.atlases)
        atlas.uv_set = set;
    send(notify, path,
         {fmt::format("TEXCOORD_{} has {} now, {:.4g} texels per metre", set,
                      unwrapping.charts == 1 ? "one chart" : fmt::format("{} charts", unwrapping.charts),
                      unwrapping.texels_per_metre)});
    return {std::move(unwrapping.atlases),
            {{"charts", unwrapping.charts}, {"texels_per_metre", unwrapping.texels_per_metre}}};
}

/// Adds the lights of `scene` to the detailed model, except those with the name of one of its lamps.
void add_lights(const Scene& scene, Scene& finer) {
    const std::vector<TransferTerm> own = lamps_of(finer);
    for (PunctualLight light : scene.lights)
        if (std::ranges::none_of(own, [&](const TransferTerm& lamp) { return lamp.name == light.name; })) {
            light.position += glm::vec3(scene.origin - finer.origin);
            finer.lights.push_back(std::move(light));
        }
}

} // namespace

double HighPolyRequest::distance_in(const Scene& scene) const {
    const Bounds box = bounds(scene);
    return distance.value_or(static_cast<double>(glm::distance(box.low, box.high)) / 50);
}

HighPoly load_high_poly(const TexelRequest& a, const GltfOptions& reading, const Scene& scene,
                        const Notify& notify) {
    HighPoly finer;
    if (a.high_poly.file.empty())
        return finer;
    finer.scene = extract_scene(load_gltf(a.high_poly.file, reading));
    send(notify, a.high_poly.file, finer.scene->notices);
    add_lights(scene, *finer.scene);
    finer.distance = a.high_poly.distance_in(scene);
    return finer;
}

TexelRoom make_room(const TexelRequest& a, const Path& path, GltfDocument& document, Scene& scene,
                    const Notify& notify) {
    if (!a.unwrap)
        return {plan_atlases(scene, a.texels)};
    try { // existing coordinates are kept if they have space for every surface
        TexelRoom room{plan_atlases(scene, a.texels)};
        send(notify, path, {fmt::format("has TEXCOORD_{} already, which is kept", a.texels.uv_set)});
        return room;
    } catch (const Error&) { // that is why
        return unwrapped(a, path, document, scene, notify);
    }
}

} // namespace prt::pipeline
