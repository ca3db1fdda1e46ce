// Selects meshes to share and bakes them.

#include "cli/pipeline/instance_sharing.h"

#include "bake/scene/receivers.h"
#include "cli/pipeline/no_shadow.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

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

/// Returns the larger of the errors under skies and under lamps, [instances].
std::vector<double> worst_errors(const InstanceBake& bake) {
    std::vector<double> errors = bake.errors;
    for (std::size_t i = 0; i < bake.lamp_errors.size(); ++i)
        errors[i] = std::max(errors[i], bake.lamp_errors[i]);
    return errors;
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

/// Nodes that coarser levels of detail replace.
std::set<int> leveled_nodes(const GltfDocument& document) {
    const LeveledScene levels = extract_levels(document);
    std::set<int> nodes;
    for (const LeveledNode& node : levels.nodes)
        for (const std::size_t p : node.finest)
            nodes.insert(levels.scene.primitives[p].node);
    return nodes;
}

/// Returns the indices of the primitives of `scene`, by node and primitive of the file.
std::map<std::pair<int, int>, std::size_t> primitives_by_node(const Scene& scene) {
    std::map<std::pair<int, int>, std::size_t> result;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        result[{scene.primitives[p].node, scene.primitives[p].primitive}] = p;
    return result;
}

/// Returns the transfer of the flat scene. That of instances is zero: levels do not read it.
Transfer flat_transfer(const FlatScene& flat, const InstancedBake& baked) {
    const Transfer& stored = baked.bake.baked.transfer;
    Transfer all = zero_transfer(stored.layout, flat.scene.receivers());
    std::set<int> shared;
    for (const SharedMesh& mesh : baked.meshes.meshes)
        for (const MeshPlacement& placement : mesh.placements)
            shared.insert(placement.node);
    const std::map<std::pair<int, int>, std::size_t> primitives = primitives_by_node(baked.stored);
    for (const Primitive& primitive : flat.scene.primitives) {
        if (shared.contains(primitive.node))
            continue;
        const int node = baked.node_of[static_cast<std::size_t>(primitive.node)];
        const Primitive& same = baked.stored.primitives[primitives.at({node, primitive.primitive})];
        const VertexArray &to = flat.scene.vertex_arrays[primitive.vertices],
                          &from = baked.stored.vertex_arrays[same.vertices];
        for (std::size_t v = 0; v < to.size(); ++v)
            std::ranges::copy(stored.vector(from.first_receiver + v),
                              all.vector(to.first_receiver + v).begin());
    }
    return all;
}

} // namespace

FoundMeshes find_shared_meshes(const GltfDocument& document, const Scene& scene, const BakeOptions& options,
                               LevelMode levels) {
    FoundMeshes found{shared_meshes(document, scene)};
    if (levels != LevelMode::ignore && has_levels(document)) {
        const std::set<int> leveled = leveled_nodes(document);
        const std::size_t before = found.meshes.placements();
        for (SharedMesh& mesh : found.meshes.meshes)
            std::erase_if(mesh.placements,
                          [&](const MeshPlacement& placement) { return leveled.contains(placement.node); });
        std::erase_if(found.meshes.meshes, [](const SharedMesh& mesh) { return mesh.placements.size() < 2; });
        found.leveled = before - found.meshes.placements();
    }
    found.other_scales = keep_one_scale(found.meshes, scene, options);
    return found;
}

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
    if (must && (asked.texels || asked.high_poly))
        throw Error("--instances shared is for vertices of the scene: leave out --texels and --high-poly");
    if (asked.texels || asked.high_poly || (asked.refined && !must))
        return {};
    FoundMeshes found = find_shared_meshes(document, scene, asked.options, asked.levels);
    SharedMeshes& meshes = found.meshes;
    if (!must && !pays(arguments, meshes, scene))
        return {};
    if (must && meshes.meshes.empty())
        throw Error("no mesh is drawn twice by nodes with rotation, translation and uniform scale: no "
                    "transfer can be shared");
    if (meshes.mirrored + meshes.uneven + meshes.bent > 0)
        send(arguments.notify, "instances",
             {fmt::format("{} are mirrored, {} singular, sheared or scaled unevenly, and {} bent by skins "
                          "or morph targets: these are baked alone",
                          meshes.mirrored, meshes.uneven, meshes.bent)});
    if (found.leveled > 0)
        send(arguments.notify, "instances",
             {fmt::format("{} have coarser levels of detail: these are baked alone", found.leveled)});
    if (found.other_scales > 0)
        send(arguments.notify, "instances",
             {fmt::format("{} contain a medium, whose lengths do not scale, and have another scale than most "
                          "instances of their mesh: these are baked alone",
                          found.other_scales)});
    return meshes;
}

GltfDocument refined(const GltfDocument& document, const Scene& scene, const SharedMeshes& meshes,
                     const Refinement& refinement) {
    SharedDocument shared = with_shared_meshes(document, meshes.meshes);
    const Scene stored = extract_scene(shared.document);
    Refinement of_stored = no_refinement(stored);
    const std::map<std::pair<int, int>, std::size_t> primitives = primitives_by_node(stored);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& flat = scene.primitives[p];
        const int node = shared.node_of[static_cast<std::size_t>(flat.node)];
        const auto to = primitives.find({node, flat.primitive});
        if (to == primitives.end())
            continue; // an instance
        of_stored.triangles[to->second] = refinement.triangles[p];
        of_stored.midpoints[stored.primitives[to->second].vertices] = refinement.midpoints[flat.vertices];
    }
    return prt::refined(std::move(shared), stored, of_stored);
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
        result.bake = bake_instances(
            {flat.scene, stored, meshes.meshes, shared.mesh_nodes, shared.node_of, result.bake.flat_lamps},
            options, with_lights, progress.range(begin, 1));
        begin = 0.5 + begin / 2;
        result.seconds += result.bake.statistics.seconds;
        result.rays += result.bake.statistics.rays;
        const std::vector<double> errors = worst_errors(result.bake);
        if (result.first_errors.empty())
            result.first_errors = errors;
        SharedMeshes kept = without_bad_ones(meshes, errors, limit);
        good = kept.placements() == meshes.placements();
        meshes = std::move(kept);
        result.baked_alone = all - meshes.placements();
        if (meshes.meshes.empty())
            return result;
        if (!good)
            continue;
        result.node_of = std::move(shared.node_of);
        result.document = std::move(shared.document);
        result.stored = std::move(stored);
    }
    result.meshes = std::move(meshes);
    return result;
}

void write_shared(InstancedBake& baked, const FlatScene& flat, BakedLevels* levels,
                  const BakeOptions& options, const Progress& progress) {
    GltfDocument& document = *baked.document;
    BakedTransfer& transfer = baked.bake.baked;
    if (!levels) {
        write_transfer(document, baked.stored, transfer);
        write_instances(document, baked.bake.instances);
        return;
    }
    // Nodes with levels are drawn once: their transfer is the same in both scenes.
    Scene stored = extract_levels(document).scene;
    leave_out_shadows(levels->scene.scene, flat.no_shadow);
    leave_out_shadows(stored, flat.no_shadow);
    bake_levels(*levels, flat_transfer(flat, baked), options, progress);
    const Transfer& all = levels->bake.transfer;
    const std::size_t coarser = all.receivers() - levels->scene.finest_receivers;
    if (stored.receivers() != baked.stored.receivers() + coarser)
        throw Error("coarser levels of detail differ in the scene of shared meshes; use --levels ignore");
    BakedTransfer whole{transfer.transfer, transfer.record, transfer.storage};
    whole.transfer.vectors.insert(whole.transfer.vectors.end(),
                                  all.vectors.end() - static_cast<std::ptrdiff_t>(coarser * all.dimension()),
                                  all.vectors.end());
    write_transfer(document, stored, whole);
    write_instances(document, baked.bake.instances);
}

} // namespace prt::pipeline
