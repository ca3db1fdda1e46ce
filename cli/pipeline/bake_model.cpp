// Bakes transfer into vertices, textures, volumes or instances of a document.

#include "cli/pipeline/bake_model.h"

#include "bake/gltf/encode_glb.h"
#include "bake/reference/scene_lamps.h"
#include "cli/pipeline/instance_report.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/level_report.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/report/bake_report.h"
#include "cli/report/lightmap_report.h"
#include "cli/report/volume_report.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/bake/refine.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace prt::pipeline {
namespace {

/// A request, its connections and the loaded model of --high-poly.
struct BakeWork : BakeRequest {
    const Host& host;
    HighPoly high_poly = {};
};

/// Replaces document and scene by the refined ones, in which instances of `meshes` and nodes with lobes are
/// unchanged. Returns nothing if refinement is off.
std::optional<RefineStatistics> refine(const BakeWork& a, GltfDocument& document, Scene& scene,
                                       SharedMeshes& meshes) {
    if (!a.finer.refine)
        return std::nullopt;
    RefineOptions how{.target = *a.finer.refine, .max_vertices = a.finer.max_vertices};
    for (const SharedMesh& mesh : meshes.meshes)
        for (const MeshPlacement& placement : mesh.placements)
            how.kept_nodes.push_back(placement.node);
    for (const Primitive& primitive : scene.primitives)
        if (scene.vertex_arrays[primitive.vertices].lobes)
            how.kept_nodes.push_back(primitive.node);
    const Stage stage = a.host.stages("refining");
    const RefineResult result = prt::refine(scene, a.options, how, stage.progress, a.high_poly.model());
    if (result.statistics.rounds == 0)
        return result.statistics;
    document = meshes.meshes.empty() ? refined(std::move(document), scene, result.refinement)
                                     : pipeline::refined(document, scene, meshes, result.refinement);
    Scene finer = extract_scene(document);
    leave_out_shadows(finer, a.no_shadow);
    finer.notices = std::move(scene.notices); // notices of the input file
    scene = std::move(finer);
    if (!meshes.meshes.empty())
        meshes = find_shared_meshes(document, scene, a.options, a.kept.levels).meshes;
    return result.statistics;
}

/// Result of a bake, and statistics of the refined mesh.
struct Baked {
    std::optional<RefineStatistics> refinement;
    BakeResult result;
};

Baked bake_scene(const BakeWork& a, GltfDocument& document, Scene& scene) {
    leave_out_shadows(scene, a.no_shadow);
    Baked baked;
    SharedMeshes none;
    baked.refinement = refine(a, document, scene, none);
    const Stage stage = a.host.stages("baking");
    baked.result = bake(scene, a.options, stage.progress, MeasureErrors::yes, a.high_poly.model());
    return baked;
}

SidesRequest sides_of(const BakeWork& a) {
    return {.sides = a.back_sides,
            .path = a.scene,
            .options = a.options,
            .no_shadow = a.no_shadow,
            .levels = a.kept.levels != LevelMode::ignore,
            .notify = a.host.notify};
}

/// Returns the scene whose surfaces and lights are baked.
const Scene& lit_scene(const BakeWork& a, const Scene& scene) {
    return a.high_poly.scene ? *a.high_poly.scene : scene;
}

/// Returns the options for a scene; bounds are converted to its coordinates.
VolumeOptions volume_options(const VolumeRequest& request, const Scene& scene) {
    VolumeOptions volume = request.volume;
    if (request.bounds)
        volume.bounds = {glm::vec3(request.bounds->least - scene.origin),
                         glm::vec3(request.bounds->most - scene.origin)};
    return volume;
}

/// Bakes the requested volume of the light of `scene`.
std::optional<VolumeBake> bake_probes(const BakeWork& a, const Scene& scene) {
    if (!a.volume.given())
        return std::nullopt;
    const Stage stage = a.host.stages("baking the volume");
    return about(a.scene, [&] {
        return bake_volume(scene, volume_options(a.volume, scene), a.options, stage.progress);
    });
}

/// Returns the file with the surface transfer in `document`, and with its volume, which was baked in `scene`.
std::vector<std::byte> with_volume(const BakeWork& a, GltfDocument& document, const Scene& scene,
                                   const std::optional<VolumeBake>& volume) {
    return about(a.scene, [&] {
        if (volume)
            write_volume(document, scene, volume->volume);
        else
            discard_volume(document);
        return encode_glb(document);
    });
}

/// Writes the transfer of the vertices of level 0, and of coarser levels if they have some.
void write_vertices(const BakeWork& a, GltfDocument& document, const Scene& scene, const BakedTransfer& baked,
                    std::optional<BakedLevels>& levels) {
    if (!levels || a.kept.levels == LevelMode::ignore) {
        write_transfer(document, scene, baked);
        return;
    }
    if (a.finer.refine) // refinement changed the mesh of level 0
        levels->scene = levels_without_lobes(document);
    Scene& all = levels->scene.scene;
    leave_out_shadows(all, a.no_shadow);
    const Stage stage = a.host.stages("levels of detail");
    bake_levels(*levels, baked.transfer, a.options, stage.progress, a.high_poly.model());
    BakedTransfer whole{std::move(levels->bake.transfer), baked.record, baked.storage};
    write_transfer(document, all, whole);
}

/// Prints a notice if the lights of the scene are far brighter than a sky of radiance 1.
void note_lights(const BakeWork& a, const Scene& scene, const Transfer& transfer,
                 std::span<const float> areas) {
    const Lighting lighting{.sky = constant_light(transfer.layout.order, glm::vec3(1)),
                            .lamps = std::vector<glm::vec3>(transfer.layout.lamps(), glm::vec3(1))};
    if (auto notice = photometric_notice(scene, relit_by(transfer, areas, a.options.threads), lighting))
        send(a.host.notify, a.scene, {std::move(*notice)});
}

void add_levels_and_volume(const std::optional<BakedLevels>& levels, const std::optional<VolumeBake>& volume,
                           Report& report) {
    if (levels)
        add_level_bake(*levels, report);
    if (volume)
        add_volume_bake(*volume, report);
}

Report run_vertices(const BakeWork& a, GltfDocument& document, Scene& scene) {
    about(a.scene, [&] { separate_sides(sides_of(a), document, scene); });
    std::optional<BakedLevels> levels = about(a.scene, [&] {
        return find_levels(a.kept.levels, a.scene, document, a.options.threads, a.host.notify);
    });
    const Baked baked = about(a.scene, [&] { return bake_scene(a, document, scene); });
    note_lights(a, scene, baked.result.baked.transfer, receiver_areas(scene));
    const Scene& lit = lit_scene(a, scene);
    const std::optional<VolumeBake> volume = bake_probes(a, lit);
    about(a.scene, [&] { write_vertices(a, document, scene, baked.result.baked, levels); });
    const std::vector<std::byte> file = with_volume(a, document, lit, volume);
    Report report = bake_report({.output = a.output.string(),
                                 .options = a.options,
                                 .no_shadow = !a.no_shadow.empty(),
                                 .scene = scene,
                                 .result = baked.result,
                                 .refinement = baked.refinement,
                                 .refine_target = a.finer.refine.value_or(0),
                                 .bytes = a.host.write(a.output, file)});
    add_levels_and_volume(levels, volume, report);
    return report;
}

/// Prints a notice for each emissive material of the scene that the model of --high-poly does not contain.
void note_missing_lamps(const BakeWork& a, const Scene& scene, const Scene& finer) {
    const std::vector<TransferTerm> baked = lamps_of(finer);
    for (const TransferTerm& lamp : lamps_of(scene))
        if (std::ranges::none_of(baked, [&](const TransferTerm& other) { return other.name == lamp.name; }))
            send(a.host.notify, a.scene,
                 {fmt::format("the model of --high-poly has no emissive material '{}': this lamp "
                              "is not baked",
                              printable(lamp.name))});
}

Report run_texels(const BakeWork& a, GltfDocument& document, Scene& scene, const TexelRoom& room) {
    leave_out_shadows(scene, a.no_shadow);
    const LightmapBake baked = about(a.scene, [&] {
        const Stage stage = a.host.stages("baking");
        return bake_lightmap(scene, room.atlases, a.options, a.high_poly.model(), stage.progress);
    });
    note_lights(a, scene, baked.lightmap.baked.transfer, baked.lightmap.areas);
    const Scene& lit = lit_scene(a, scene);
    const std::optional<VolumeBake> volume = bake_probes(a, lit);
    about(a.scene, [&] { write_lightmap(document, scene, baked.lightmap); });
    const std::vector<std::byte> file = with_volume(a, document, lit, volume);
    Report report = lightmap_report(
        {.output = a.output.string(), .scene = scene, .bake = baked, .bytes = a.host.write(a.output, file)});
    add_figures(report, room.figures);
    if (volume)
        add_volume_bake(*volume, report);
    return report;
}

Report run_instances(const BakeWork& a, SharedMeshes meshes, GltfDocument& document, Scene& scene) {
    leave_out_shadows(scene, a.no_shadow);
    about(a.scene, [&] { separate_sides_of_meshes(sides_of(a), meshes, document, scene); });
    const std::optional<RefineStatistics> refinement =
        about(a.scene, [&] { return refine(a, document, scene, meshes); });
    std::optional<BakedLevels> levels = about(a.scene, [&] {
        return find_levels(a.kept.levels, a.scene, document, a.options.threads, a.host.notify);
    });
    const FlatScene flat{document, scene, a.no_shadow};
    InstancedBake baked = about(a.scene, [&] {
        const Stage stage = a.host.stages("baking");
        return bake_shared(a.instances, flat, std::move(meshes), a.options, stage.progress);
    });
    if (!baked.document) {
        send(a.host.notify, "instances",
             {fmt::format("all {} have an error above {:.3g} %: each is baked separately", baked.baked_alone,
                          100 * a.instances.error)});
        return run_vertices(a, document, scene);
    }
    const std::optional<VolumeBake> volume = bake_probes(a, scene);
    about(a.scene, [&] {
        if (!levels || a.kept.levels == LevelMode::ignore)
            return write_shared(baked, flat, nullptr, a.options, {});
        const Stage stage = a.host.stages("levels of detail");
        write_shared(baked, flat, &*levels, a.options, stage.progress);
    });
    const std::vector<std::byte> file = with_volume(a, *baked.document, scene, volume);
    Report report = instance_report({.output = a.output.string(),
                                     .scene = scene,
                                     .baked = baked,
                                     .error = a.instances.error,
                                     .refinement = refinement,
                                     .refine_target = a.finer.refine.value_or(0),
                                     .bytes = a.host.write(a.output, file)});
    add_levels_and_volume(levels, volume, report);
    return report;
}

/// Prints a notice about vertices with lobes, which get no transfer. Throws `Error` if all vertices have
/// lobes.
void check_lobes_of(const BakeWork& a, const Scene& scene) {
    const std::size_t count = vertices_with_lobes(scene);
    if (count == 0)
        return;
    if (count == scene.receivers())
        throw Error(
            a.scene.string() +
            ": all vertices have lobes, so nothing needs transfer; --stored-lobes remove bakes transfer");
    send(a.host.notify, a.scene,
         {prt::counted(count, "vertex keeps its lobes and gets no transfer",
                       "vertices keep their lobes and get no transfer") +
          " (--stored-lobes remove bakes it)"});
}

} // namespace

Report bake_model(BakeRequest request, GltfDocument document, const Host& host) {
    BakeWork a{std::move(request), host};
    if (a.texels.given() && a.finer.refine)
        throw Error(
            "--refine and --texels cannot be combined: --refine splits triangles for light at vertices");
    a.options.repairs.bad_textures = a.reading.bad_textures;
    a.instances.notify = host.notify;
    if (a.finer.refine && a.options.fit == FitMode::automatic)
        a.options.fit = FitMode::surface; // the fit with which the refinement measures errors
    a.texels.texels.leave_out_lobes = true;
    if (a.kept.lobes == LobesOfFile::remove)
        discard_lobes(document);
    Scene scene = extract_scene(document);
    read_occluders(document); // which it passes on
    read_lobes(document, scene);
    send(host.notify, a.scene, scene.notices);
    check_lobes_of(a, scene);
    a.high_poly = load_high_poly(a.texels, a.reading, scene, host.notify);
    if (a.high_poly.scene && a.options.lamps.mode != LampMode::none)
        note_missing_lamps(a, scene, *a.high_poly.scene);
    TexelRoom room;
    if (a.texels.given() && a.texels.unwrap)
        about(a.scene, [&] { separate_sides(sides_of(a), document, scene); });
    if (a.texels.given())
        room = about(a.scene, [&] { return make_room(a.texels, a.scene, document, scene, host.notify); });
    const SharedMeshes meshes = about(a.scene, [&] {
        return meshes_to_share(a.instances, document, scene,
                               {a.options, a.texels.given(), a.high_poly.scene.has_value(),
                                a.finer.refine.has_value(), a.kept.levels});
    });
    if (a.texels.given() && a.kept.levels != LevelMode::ignore && has_levels(document))
        send(host.notify, a.scene, {"coarser levels of detail get no lightmap"});
    if (a.texels.given())
        return run_texels(a, document, scene, room);
    return meshes.meshes.empty() ? run_vertices(a, document, scene)
                                 : run_instances(a, meshes, document, scene);
}

} // namespace prt::pipeline
