// prt info: prints the transfer in a file and its size.

#include "cli/commands/commands.h"

#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/pipeline/instance_report.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/scene_check.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "cli/report/lightmap_report.h"
#include "cli/report/of_texels.h"
#include "cli/report/transfer_words.h"
#include "cli/report/volume_report.h"
#include "prt/core/cluster_lighting.h"
#include "prt/gltf/levels.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

namespace prt::cli {
namespace {

struct InfoArguments {
    Path file, json;
    ReadingOptions reading;
    bool check = false;
};

/// Returns "{images:#image}", which a report writes as "1 image" or "2 images".
std::string counted(const std::string& key, const char* what) {
    return fmt::format("{{{}:#{}}}", key, what);
}

/// Returns a sentence about the bake; `key` is the path of its record.
std::string record_sentence(const std::string& key, const BakeRecord& record) {
    const bool raster = record.method == BakeMethod::raster;
    return fmt::format("baked by {} on the {}, {} per vertex{}, {}, seed {{{}/seed}}",
                       raster ? "depth maps" : "rays", record.backend == Backend::cpu ? "CPU" : "GPU",
                       counted(key + "/rays_per_receiver", raster ? "direction" : "ray"),
                       record.fitted ? " over the surface around it" : "",
                       record.endless ? "all bounces" : counted(key + "/bounces", "bounce"), key);
}

void add_scene(const Path& path, const Scene& scene, Report& report) {
    const Bounds box = bounds(scene);
    const glm::dvec3 low = scene.world(box.low), high = scene.world(box.high);
    const std::size_t materials = scene.materials.size() - 1;
    add_figures(report, {{"file", path.string()},
                         {"primitives", scene.primitives.size()},
                         {"triangles", scene.triangles()},
                         {"vertices", scene.receivers()},
                         {"materials", materials},
                         {"images", scene.images.size()},
                         {"low_metres", {low.x, low.y, low.z}},
                         {"high_metres", {high.x, high.y, high.z}},
                         {"notices", scene.notices}});
    report.sentences.push_back(
        fmt::format("{{file}}: {}, {}, {{vertices}} {}, {}, {}", counted("primitives", "primitive"),
                    counted("triangles", "triangle"), scene.receivers() == 1 ? "vertex" : "vertices",
                    counted("materials", "material"), counted("images", "image")));
    report.sentences.emplace_back("from {low_metres/0:g} {low_metres/1:g} {low_metres/2:g} to "
                                  "{high_metres/0:g} {high_metres/1:g} {high_metres/2:g} m");
}

void add_baked(const BakedTransfer& baked, Report& report) {
    const Transfer& t = baked.transfer;
    const bool half = baked.storage == TransferStorage::float16;
    add_figures(
        report,
        {{"transfer",
          {{"order", t.layout.order},
           {"channels", t.layout.channels()},
           {"terms", terms_figures(t.layout)},
           {"bytes_stored_per_vertex", t.dimension() * (half ? sizeof(std::uint16_t) : sizeof(float))},
           {"bake", bake_record_json(baked.record)}}}});
    report.sentences.push_back(
        fmt::format("raw transfer: order {{transfer/order}}, {}, {{transfer/bytes_stored_per_vertex}} bytes "
                    "per vertex as {}",
                    terms_in_words(t.layout), half ? "float16" : "float32"));
    report.sentences.push_back(record_sentence("transfer/bake", baked.record));
}

/// Adds the predictors of clusters, which need no bytes per vertex, and their shader cost.
void add_predictors(const ClusteredBases& bases, const std::string& own, Report& report) {
    if (bases.predictors.empty())
        return;
    report.sentences.push_back(fmt::format("predictors: {0}: {{{1}predictor_rows}} rows in each cluster and "
                                           "no bytes per vertex; the shader does "
                                           "{{{1}predictor_rows}} multiply-adds of a color",
                                           fmt::join(predictor_names(bases), " and "), own));
}

std::size_t vertices_without_lobes(const Scene& scene) {
    return scene.receivers() - vertices_with_lobes(scene);
}

/// Adds compressed transfer of `receivers` receivers.
void add_compressed(const CompressedTransfer& compressed, std::size_t receivers, Report& report) {
    const ClusteredTransfer& t = compressed.transfer;
    const auto [least, most] = std::minmax_element(t.bases.components.begin(), t.bases.components.end());
    add_figures(report, {{"clustered_pca",
                          {{"order", t.bases.layout.order},
                           {"channels", t.bases.layout.channels()},
                           {"terms", terms_figures(t.bases.layout)},
                           {"clusters", t.bases.clusters()},
                           {"components_least", *least},
                           {"components_max", *most},
                           {"weights", t.receivers.format == WeightFormat::packed ? "packed" : "float"},
                           {"bytes_bound_per_vertex", bytes_per_receiver(t)},
                           {"bits_used_per_vertex", bits_per_receiver(t)},
                           {"predictors", predictor_names(t.bases)},
                           {"predictor_rows", t.bases.predictor_rows()},
                           {"bytes_bases", basis_bytes(t.bases)},
                           {"bytes_attributes", receivers * bytes_per_receiver(t)},
                           {"bytes_constants", constant_rows(t.bases) * sizeof(glm::vec4)},
                           {"bytes_ram", ClusterLighting(t).matrix().size_bytes()},
                           {"bake", bake_record_json(compressed.record)}}}});
    const std::string own = "clustered_pca/";
    report.sentences.push_back(
        fmt::format("clustered PCA: order {{{0}order}}, {1}, {2} x {{{0}components_least}} to "
                    "{{{0}components_max}} components, {{{0}weights}} weights",
                    own, terms_in_words(t.bases.layout), counted(own + "clusters", "cluster")));
    report.sentences.push_back(fmt::format(
        "{{{0}bytes_bound_per_vertex}} bytes per vertex to bind ({{{0}bits_used_per_vertex}} bits in use)",
        own));
    add_predictors(t.bases, own, report);
    report.sentences.push_back(fmt::format("bases: {{{0}bytes_bases}} bytes on disk, {{{0}bytes_ram}} bytes "
                                           "of RAM in a game; {1} shader constants",
                                           own, constant_rows(t.bases)));
    report.sentences.push_back(fmt::format(
        "GPU: {{{0}bytes_attributes}} bytes of attributes, {{{0}bytes_constants}} of constants per lighting",
        own));
    report.sentences.push_back(record_sentence(own + "bake", compressed.record));
}

void add_instances(const InstancedModel& file, Report& report) {
    const std::size_t lamps = file.instances.empty() ? 0 : file.instances.front().placed.lamps.size(),
                      bytes = kInstanceNumbers + lamps * kLampLightBytes;
    Json figures = {{"count", file.instances.size()},
                    {"vertices_stored", vertices_without_lobes(file.stored)},
                    {"bytes_per_instance", bytes}};
    report.sentences.emplace_back("instances that share the transfer of their meshes: {instances/count}, by "
                                  "{instances/bytes_per_instance} bytes each; "
                                  "{instances/vertices_stored:#vertex has|vertices have} transfer");
    if (file.compressed) {
        add_instance_constants(relit_instances(file), std::move(figures), report);
        return;
    }
    add_figures(report, {{"instances", std::move(figures)}});
}

void add_lightmap(const SceneFile& model, Report& report) {
    const LightmapLayout& layout = model.lightmap->layout;
    add_figures(report, {{"lightmap", {{"maps", maps_figures(layout)}, {"texels", layout.texels()}}}});
    report.sentences.push_back("lightmap: " + maps_in_words(layout) + ", {lightmap/texels} texels");
}

void add_volume(const VolumeGrid& grid, std::size_t probes, int order, Report& report) {
    add_figures(report, {{"volume", grid_figures(grid, probes, order)}});
    report.sentences.push_back(grid_sentence("volume"));
}

void add_stored_lobes(const StoredLobes& lobes, std::size_t vertices, Report& report) {
    const LobeModel& model = lobes.model;
    add_figures(report, {{"lobes",
                          {{"vertices", vertices},
                           {"order", model.order},
                           {"lobes_per_vertex", model.lobes},
                           {"bytes_bound_per_vertex", model.lobes * sizeof(LobeWord)},
                           {"profiles", model.profiles.size()},
                           {"poses", lobes.record.poses},
                           {"rays_per_receiver", lobes.record.rays},
                           {"bounces", lobes.record.bounces},
                           {"seed", lobes.record.seed}}}});
    report.sentences.push_back(
        fmt::format("lobes that rotate with the skin: order {{lobes/order}}, {} and "
                    "{{lobes/bytes_bound_per_vertex}} bytes per vertex, {{lobes/vertices}} {}, "
                    "{{lobes/profiles}} profiles",
                    counted("lobes/lobes_per_vertex", "lobe"), vertices == 1 ? "vertex" : "vertices"));
    report.sentences.push_back(fmt::format(
        "fitted to {}, {{lobes/rays_per_receiver}} rays per vertex in each, {}, seed {{lobes/seed}}",
        counted("lobes/poses", "pose"), counted("lobes/bounces", "bounce")));
}

/// Adds coarser levels of detail, which the figures of the scene do not include.
void add_level_figures(const GltfDocument& document, Report& report) {
    if (!has_levels(document))
        return;
    const LeveledScene scene = extract_levels(document);
    std::map<int, std::array<std::size_t, 2>> by_level; // triangles and vertices
    for (const LeveledNode& node : scene.nodes)
        for (const CoarserLevel& level : node.coarser) {
            by_level[level.level][1] += vertices_of(scene.scene, level.primitives);
            for (const std::size_t p : level.primitives)
                by_level[level.level][0] += scene.scene.primitives[p].triangles.size();
        }
    const bool transfer = levels_have_transfer(document, scene);
    std::vector<LeveledNode> moving = scene.nodes;
    keep_levels(moving, scene.scene,
                [&](const Primitive& p) { return scene.scene.vertex_arrays[p.vertices].lobes; });
    Json list = Json::array();
    std::string words;
    for (const auto& [level, counts] : by_level) {
        list.push_back({{"level", level}, {"triangles", counts[0]}, {"vertices", counts[1]}});
        words += fmt::format("{}level {} has {} triangles", words.empty() ? "" : ", ", level, counts[0]);
    }
    add_figures(report, {{"levels",
                          {{"nodes", scene.nodes.size()},
                           {"by_level", std::move(list)},
                           {"transfer", transfer},
                           {"nodes_with_lobes", moving.size()}}}});
    report.sentences.push_back(fmt::format("levels of detail of {}: {}; {}", counted("levels/nodes", "node"),
                                           words,
                                           transfer         ? "with transfer"
                                           : moving.empty() ? "without transfer"
                                                            : "without transfer, with lobes"));
}

void run(InfoArguments a, Session& session) {
    a.reading.outputs = check_outputs({{a.json, "--json", {".json"}}}, {a.file});
    const SceneFile model = load_scene_file(a.file, a.reading);
    Report report;
    add_scene(a.file, model.scene, report);
    if (model.lightmap)
        add_lightmap(model, report);
    const bool shared = model.instanced && model.instanced->compressed;
    if (model.instanced)
        add_instances(*model.instanced, report);
    if (model.baked && !shared)
        add_baked(*model.baked, report);
    if (shared)
        add_compressed(*model.instanced->compressed, vertices_without_lobes(model.instanced->stored), report);
    if (model.compressed)
        add_compressed(*model.compressed,
                       model.lightmap ? model.lightmap->layout.texels() : vertices_without_lobes(model.scene),
                       report);
    if (model.volume)
        add_volume(model.volume->grid, model.volume->visibility.size(), model.volume->order, report);
    if (model.compressed_volume)
        add_volume(model.compressed_volume->grid, model.compressed_volume->visibility.size(),
                   model.compressed_volume->order, report);
    if (!model.occluders.empty()) {
        add_figures(report, {{"occlusion_volumes", model.occluders.size()}});
        report.sentences.push_back("{occlusion_volumes} nodes have an occlusion volume");
    }
    if (model.lobes)
        add_stored_lobes(*model.lobes, vertices_with_lobes(model.scene), report);
    add_level_figures(model.document, report);
    if (!model.record() && !model.lobes)
        report.sentences.emplace_back("no transfer");
    if (model.lightmap)
        report_texels(report);
    if (a.check) {
        const std::vector<Finding> findings = check_model(model);
        add_findings(findings, report);
        session.set_status(findings.empty() ? 0 : 1);
    }
    publish(report, a.json, session);
}

} // namespace

void add_info(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("info", "List the contents of a glTF file");
    auto& a = arguments_for<InfoArguments>(command,
                                           [&session](const InfoArguments& given) { run(given, session); });
    command
        ->add_option("file", a.file, "file to describe: glTF 2.0 with triangles (.gltf, .glb), .obj or .ply")
        ->required()
        ->check(named);
    command->add_flag(
        "--check", a.check,
        "also list problems with remedies; exit status 1 if there are any\n"
        "parts that a bake ignores, as normal maps, are also problems: status 1, though the remedy\n"
        "  is that no action is needed");
    add_reading(command, a.reading);
    add_json(command, a.json);
}

} // namespace prt::cli
