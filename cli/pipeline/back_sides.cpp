// Gives both sides of double-sided surfaces separate vertices.

#include "cli/pipeline/back_sides.h"

#include "bake/gltf/separate_sides.h"
#include "bake/refine/sides.h"
#include "cli/pipeline/no_shadow.h"
#include "prt/gltf/levels.h"
#include "runtime/support/counted.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>

namespace prt::pipeline {
namespace {

/// Returns "18 double-sided triangles": the number of true elements.
std::string double_sided(const std::vector<bool>& triangles) {
    return counted(std::ranges::count(triangles, true), "double-sided triangle");
}

/// All levels of detail; light passes the coarser ones.
Scene scene_of_levels(const GltfDocument& document, const std::vector<std::string>& no_shadow) {
    LeveledScene levels = extract_levels(document);
    Scene& scene = levels.scene;
    leave_out_shadows(scene, no_shadow);
    std::map<std::size_t, std::size_t> coarse; // copies of materials
    for (std::size_t p = levels.finest_primitives; p < scene.primitives.size(); ++p) {
        const std::size_t material = scene.primitives[p].material;
        const auto [copy, is_new] = coarse.try_emplace(material, scene.materials.size());
        if (is_new) {
            scene.materials.push_back(Material(scene.materials[material]));
            scene.materials.back().casts_shadow = false;
        }
        scene.primitives[p].material = copy->second;
    }
    return std::move(scene);
}

} // namespace

void separate_sides(const SidesRequest& request, GltfDocument& document, Scene& scene) {
    if (request.sides == BackSides::shared)
        return;
    leave_out_shadows(scene, request.no_shadow);
    std::optional<Scene> levels;
    if (request.levels && has_levels(document))
        levels = scene_of_levels(document, request.no_shadow);
    const Scene& all = levels ? *levels : scene;
    const std::vector<bool> triangles = sides_to_separate(all, request.options);
    if (triangles.empty())
        return;
    document = with_separate_sides(std::move(document), all, triangles);
    Scene separate = extract_scene(document);
    leave_out_shadows(separate, request.no_shadow);
    separate.notices = std::move(scene.notices); // notices of the input file
    const std::size_t added = separate.receivers() - scene.receivers();
    scene = std::move(separate); // the one of the document, also where a variant culls all of the backs
    if (added == 0)
        return;
    const std::string notice =
        fmt::format("light reaches the back sides of {}; {} added for it (--back-sides shared adds none)",
                    double_sided(triangles), counted(added, "vertex was", "vertices were"));
    send(request.notify, request.path, {notice});
    scene.notices.push_back(notice);
}

void note_shared_sides(const SidesRequest& request, const Scene& scene) {
    const std::vector<bool> triangles =
        request.sides == BackSides::shared ? std::vector<bool>{} : sides_to_separate(scene, request.options);
    if (!triangles.empty())
        send(request.notify, request.path,
             {fmt::format("light reaches the back sides of {}; instances with shared transfer show the light "
                          "of the front sides there",
                          double_sided(triangles))});
}

} // namespace prt::pipeline
