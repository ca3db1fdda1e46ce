// Selects meshes to share and bakes them.

#include "cli/pipeline/instance_sharing.h"

#include "bake/scene/receivers.h"
#include "cli/pipeline/no_shadow.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::pipeline {
namespace {

std::size_t vertices_of(const Scene& scene, int node) {
    std::size_t count = 0;
    std::vector<bool> seen(scene.vertex_arrays.size());
    for (const Primitive& primitive : scene.primitives)
        if (primitive.node == node && !seen[primitive.vertices]) {
            seen[primitive.vertices] = true;
            count += scene.vertex_arrays[primitive.vertices].size();
        }
    return count;
}

/// True if sharing leaves at most a quarter of the receivers to trace.
bool pays(const InstanceArguments& arguments, const SharedMeshes& meshes, const Scene& scene) {
    std::size_t all = 0, traced = 0;
    for (const SharedMesh& mesh : meshes.meshes) {
        const std::size_t vertices = vertices_of(scene, mesh.placements.front().node);
        all += vertices * mesh.placements.size();
        traced +=
            vertices +
            mesh.placements.size() *
                std::min(vertices, static_cast<std::size_t>(arguments.bake.rays * arguments.bake.samples));
    }
    return all >= 4 * traced;
}

/// Removes placements with an error above `most`, and meshes with at most one remaining placement.
SharedMeshes without_bad_ones(const SharedMeshes& meshes, const std::vector<double>& errors, double most) {
    SharedMeshes kept = meshes;
    kept.meshes.clear();
    std::size_t i = 0;
    for (const SharedMesh& mesh : meshes.meshes) {
        SharedMesh good{mesh.mesh, {}};
        for (const MeshPlacement& placement : mesh.placements)
            if (errors[i++] <= most)
                good.placements.push_back(placement);
        if (good.placements.size() >= 2)
            kept.meshes.push_back(std::move(good));
    }
    return kept;
}

} // namespace

SharedMeshes meshes_to_share(const InstanceArguments& arguments, const GltfDocument& document,
                             const Scene& scene, const AskedFor& asked) {
    if (arguments.mode == InstanceMode::own) {
        if (!arguments.lights.empty())
            throw Error("--lights of prt bake needs --instances shared or auto");
        if (arguments.settings)
            throw Error("settings of --instances need shared or auto");
        return {};
    }
    const bool must = arguments.mode == InstanceMode::shared;
    if (asked.other) {
        if (must)
            throw Error("--instances shared is for vertices as they are: leave out --texels and --refine");
        return {};
    }
    SharedMeshes meshes = shared_meshes(document, scene);
    const std::size_t other_scales = keep_one_scale(meshes, scene, asked.options);
    const bool other_light =
        (asked.options.lamps.mode != LampMode::none &&
         (!scene.lights.empty() || std::ranges::any_of(scene.materials, [](const Material& material) {
             return material.emission.radiance != glm::vec3(0);
         })));
    if (!must && (other_light || !pays(arguments, meshes, scene)))
        return {};
    if (must && meshes.meshes.empty())
        throw Error("no mesh is drawn twice by nodes with rotation, translation and uniform scale: no "
                    "transfer can be shared");
    if (meshes.mirrored + meshes.uneven + meshes.bent > 0)
        send(arguments.notify, "instances",
             {fmt::format("{} are mirrored, {} singular, sheared or scaled unevenly, and {} bent by skins "
                          "or morph targets: these are baked alone",
                          meshes.mirrored, meshes.uneven, meshes.bent)});
    if (other_scales > 0)
        send(arguments.notify, "instances",
             {fmt::format("{} contain a medium, whose lengths do not scale, and have another scale than most "
                          "instances of their mesh: these are baked alone",
                          other_scales)});
    return meshes;
}

InstancedBake bake_shared(const InstanceArguments& arguments, const FlatScene& flat, SharedMeshes meshes,
                          const BakeOptions& options, const Progress& progress) {
    InstancedBake result;
    const std::size_t all = meshes.placements();
    InstanceBakeOptions with_lights = arguments.bake;
    for (const Path& path : arguments.lights)
        with_lights.lights.push_back(lighting_of(
            load_light(path, options.order, arguments.suns, {.notify = arguments.notify}, options.threads)));
    // errors of the remaining instances change slightly when others are baked separately
    constexpr double kFirstShare = 0.93;
    double begin = 0, limit = kFirstShare * arguments.error;
    for (bool good = false; !good; limit = arguments.error) {
        SharedDocument shared = with_shared_meshes(flat.document, meshes.meshes);
        Scene stored = extract_scene(shared.document);
        leave_out_shadows(stored, flat.no_shadow);
        result.bake = bake_instances({flat.scene, stored, meshes.meshes, shared.mesh_nodes, shared.node_of},
                                     options, with_lights, progress.range(begin, 1));
        begin = 0.5 + begin / 2;
        result.seconds += result.bake.statistics.seconds;
        result.rays += result.bake.statistics.rays;
        if (result.first_errors.empty())
            result.first_errors = result.bake.errors;
        SharedMeshes kept = without_bad_ones(meshes, result.bake.errors, limit);
        good = kept.placements() == meshes.placements();
        meshes = std::move(kept);
        result.baked_alone = all - meshes.placements();
        if (meshes.meshes.empty())
            return result;
        if (!good)
            continue;
        write_transfer(shared.document, stored, result.bake.baked);
        write_instances(shared.document, result.bake.instances);
        result.document = std::move(shared.document);
    }
    result.meshes = std::move(meshes);
    return result;
}

} // namespace prt::pipeline
