// Gives both sides of double-sided surfaces separate vertices.

#include "cli/pipeline/back_sides.h"

#include "bake/gltf/separate_sides.h"
#include "bake/refine/sides.h"
#include "cli/pipeline/instance_sharing.h"
#include "cli/pipeline/no_shadow.h"
#include "prt/gltf/levels.h"
#include "runtime/core/support/counted.h"

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
Scene scene_of_levels(LeveledScene levels, const std::vector<std::string>& no_shadow) {
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

/// Sends the notice about separate sides of `triangles`, and returns it.
std::string note_separated(const SidesRequest& request, const std::vector<bool>& triangles,
                           std::size_t added) {
    std::string notice =
        fmt::format("light reaches the back sides of {}; {} added for it (--back-sides shared adds none)",
                    double_sided(triangles), counted(added, "vertex was", "vertices were"));
    send(request.notify, request.path, {notice});
    return notice;
}

/// Takes the scene of a document with separate sides of `triangles`, and sends a notice.
void take_scene(const SidesRequest& request, const std::vector<bool>& triangles, const GltfDocument& document,
                Scene& scene) {
    Scene separate = extract_scene(document);
    leave_out_shadows(separate, request.no_shadow);
    separate.notices = std::move(scene.notices); // notices of the input file
    const std::size_t added = separate.receivers() - scene.receivers();
    scene = std::move(separate); // the one of the document, also where a variant culls all of the backs
    if (added > 0)
        scene.notices.push_back(note_separated(request, triangles, added));
}

/// Returns the triangles of the stored scene that correspond to any of `triangles` of the flat scene.
std::vector<bool> triangles_of_meshes(const Scene& scene, const std::vector<bool>& triangles,
                                      const SharedMeshes& meshes, const SharedDocument& shared,
                                      const Scene& stored) {
    std::vector<int> node_of = shared.node_of; // node of `stored` that draws the triangles of a node
    for (std::size_t m = 0; m < meshes.meshes.size(); ++m)
        for (const MeshPlacement& placement : meshes.meshes[m].placements)
            node_of[static_cast<std::size_t>(placement.node)] = shared.mesh_nodes[m];
    std::map<std::pair<int, int>, std::size_t> first; // first triangle by node and primitive of `stored`
    std::vector<bool> result;
    for (const Primitive& primitive : stored.primitives) {
        first[{primitive.node, primitive.primitive}] = result.size();
        result.resize(result.size() + primitive.triangles.size());
    }
    std::size_t next = 0;
    for (const Primitive& primitive : scene.primitives) {
        const std::size_t to =
            first.at({node_of[static_cast<std::size_t>(primitive.node)], primitive.primitive});
        for (std::size_t t = 0; t < primitive.triangles.size(); ++t)
            if (triangles[next++])
                result[to + t] = true;
    }
    return result;
}

} // namespace

void separate_sides(const SidesRequest& request, GltfDocument& document, Scene& scene) {
    if (request.sides == BackSides::shared)
        return;
    leave_out_shadows(scene, request.no_shadow);
    std::optional<Scene> levels;
    if (request.levels && has_levels(document))
        levels = scene_of_levels(extract_levels(document), request.no_shadow);
    const Scene& all = levels ? *levels : scene;
    const std::vector<bool> triangles = sides_to_separate(all, request.options);
    if (triangles.empty())
        return;
    document = with_separate_sides(std::move(document), all, triangles);
    take_scene(request, triangles, document, scene);
}

void separate_sides_of_meshes(const SidesRequest& request, SharedMeshes& meshes, GltfDocument& document,
                              Scene& scene) {
    if (request.sides == BackSides::shared)
        return;
    leave_out_shadows(scene, request.no_shadow);
    const bool leveled = request.levels && has_levels(document);
    std::optional<Scene> levels;
    if (leveled)
        levels = scene_of_levels(extract_levels(document), request.no_shadow);
    const Scene& all = levels ? *levels : scene;
    const std::vector<bool> triangles = sides_to_separate(all, request.options);
    if (triangles.empty())
        return;
    SharedDocument shared = with_shared_meshes(document, meshes.meshes);
    const Scene stored = leveled ? extract_levels(shared.document).scene : extract_scene(shared.document);
    const std::vector<bool> of_stored = triangles_of_meshes(all, triangles, meshes, shared, stored);
    document = with_separate_sides_of_meshes(std::move(shared), stored, of_stored);
    take_scene(request, triangles, document, scene);
    meshes = find_shared_meshes(document, scene, request.options,
                                request.levels ? LevelMode::carry : LevelMode::ignore)
                 .meshes;
}

bool separate_sides_of_figure(const SidesRequest& request, const AnimatedScene& model, const Scene& scene,
                              std::span<const ModelPose> poses, GltfDocument& document) {
    if (request.sides == BackSides::shared)
        return false;
    std::vector<bool> triangles(scene.triangles());
    for (const ModelPose& pose : poses) {
        Scene posed = scene_of_levels(scene_in_pose(model, pose, {}), request.no_shadow);
        for (std::size_t array = 0; array < posed.vertex_arrays.size(); ++array)
            posed.vertex_arrays[array].lobes = !scene.vertex_arrays[array].lobes; // these are not separated
        const std::vector<bool> lit = sides_to_separate(posed, request.options);
        for (std::size_t t = 0; t < lit.size(); ++t)
            triangles[t] = triangles[t] || lit[t];
    }
    if (std::ranges::find(triangles, true) == triangles.end())
        return false;
    document = with_separate_sides(std::move(document), scene, triangles, ChangedMeshes::with_lobes);
    const Scene separate = request.levels ? extract_levels(document).scene : extract_scene(document);
    if (const std::size_t added = separate.receivers() - scene.receivers(); added > 0)
        note_separated(request, triangles, added);
    return true;
}

} // namespace prt::pipeline
