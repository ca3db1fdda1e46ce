// Compresses transfer of vertices, textures, volumes or instances.

#include "cli/pipeline/compress_model.h"

#include "bake/gltf/encode_glb.h"
#include "bake/gltf/reorder.h"
#include "bake/gltf/stored_transfer.h"
#include "cli/pipeline/fallback.h"
#include "cli/pipeline/instance_report.h"
#include "cli/pipeline/sky_errors.h"
#include "cli/report/of_texels.h"
#include "cli/report/trace_lines.h"
#include "cli/report/transfer_words.h"
#include "cli/report/volume_report.h"
#include "compress/metric/jumps.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/compress/compress.h"
#include "prt/compress/search.h"
#include "prt/core/cluster_lighting.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/gltf/levels.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/render/lightmap_file.h"
#include "runtime/load/mesh_edges.h"
#include "runtime/load/shared_instances.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

namespace prt::pipeline {
namespace {

/// A request and its connections.
struct CompressWork : CompressRequest {
    const Host& host;
};

/// "error 0.012, 5.1 bytes per vertex, 6.2 shader operations"
std::string in_words(const CompressStatistics& s, std::size_t receivers) {
    return fmt::format("lit_rms {:.4g}, {:.2f} bytes per vertex, {:.2f} shader operations", s.lit_rms,
                       s.bytes_with_bases(receivers), s.operations());
}

/// A guarantee: its option, and a sentence with the unit of its figures.
struct PromiseWords {
    const char *option, *what;
    bool percent = false;
};

PromiseWords words_of(Promise promise) {
    switch (promise) {
    case Promise::error:
        return {"--max-error", "lit_rms under the worst sky", true};
    case Promise::skies:
        return {"--max-error", "contrast error under skies", true};
    case Promise::lamps:
        return {"--max-error", "contrast error of lamps", true};
    case Promise::jump:
        return {"--max-jump", "jumps across clusters", true};
    case Promise::bytes:
        return {"--bytes-per-vertex", "bytes per vertex"};
    case Promise::operations:
        break;
    }
    return {"--shader-ops", "shader operations"};
}

/// "jumps across clusters 4.95 % of 5 % (--max-jump)"
std::string in_words(const PromiseKept& kept) {
    const PromiseWords words = words_of(kept.promise);
    return words.percent
               ? fmt::format("{} {:.4g} % of {:.4g} % ({})", words.what, 100 * kept.reached, 100 * kept.limit,
                             words.option)
               : fmt::format("{} {:.4g} of {:.4g} ({})", words.what, kept.reached, kept.limit, words.option);
}

std::string in_words(std::span<const PromiseKept> promises) {
    std::vector<std::string> words;
    for (const PromiseKept& kept : promises)
        words.push_back(in_words(kept));
    return fmt::format("{}", fmt::join(words, "; "));
}

struct Outcome {
    CompressResult result;
    std::vector<SearchTrial> trials;
    std::optional<SearchTrial> best; ///< best trial of a search
};

/// A bake to compress. Its transfer keeps the format of the file, and its vertices are in the document.
struct Bake {
    GltfDocument document;
    StoredBake stored;
    Scene scene; ///< vertices with transfer: level 0, and coarser levels if they have transfer
    std::optional<BakedLightmap> lightmap = {}; ///< bake of texels; its transfer is in `stored`
    std::optional<BakedVolume> volume = {};
    bool levels = false;                      ///< coarser levels of detail have transfer, too
    std::size_t finest_receivers = 0;         ///< with `levels`: number of vertices of level 0
    std::vector<FileInstance> instances = {}; ///< instances that share transfer
};

Bake of_lightmap(GltfDocument document, Scene scene, BakedLightmap lightmap) {
    BakedTransfer& baked = lightmap.baked;
    StoredBake stored{{baked.transfer.layout, std::move(baked.transfer.vectors), {}}, baked.record};
    return {std::move(document), std::move(stored), std::move(scene), std::move(lightmap)};
}

/// Returns the levels of the document if they have transfer.
std::optional<LeveledScene> levels_to_compress(const GltfDocument& document) {
    if (!has_levels(document))
        return std::nullopt;
    LeveledScene levels = extract_levels(document);
    return levels_have_transfer(document, levels) ? std::optional(std::move(levels)) : std::nullopt;
}

/// Returns the bake of vertices or texels.
Error already_compressed(const Path& path) {
    return Error(path.string() + ": is already compressed; compress its bake");
}

Bake bake_of_surfaces(GltfDocument document, Scene scene, const Path& path, const Notify& notify) {
    if (std::optional<BakedLightmap> lightmap = read_lightmap(document, scene)) {
        discard_transfer(document);
        return of_lightmap(std::move(document), std::move(scene), std::move(*lightmap));
    }
    std::optional<LeveledScene> levels = levels_to_compress(document);
    if (levels)
        scene = std::move(levels->scene);
    std::optional<StoredBake> stored = read_stored_transfer(document, scene);
    if (!stored)
        throw scene_file_of(std::move(document), path, notify).compressed
            ? already_compressed(path)
            : Error(path.string() + ": contains no transfer; run prt bake first");
    discard_transfer(document); // it is in `stored`, and would use memory twice
    Bake bake{std::move(document), std::move(*stored), std::move(scene)};
    bake.levels = levels.has_value();
    bake.finest_receivers = levels ? levels->finest_receivers : 0;
    return bake;
}

/// Reads the instances. Throws `Error` for invalid ones, because compression copies their positions.
std::vector<FileInstance> instances_of(const CompressWork& a, const GltfOptions& reading,
                                       const Scene& stored) {
    const GltfDocument document = a.baked.read(reading);
    return read_instances(document, extract_scene(document), stored);
}

Bake load_bake(const CompressWork& a) {
    const Path& path = a.baked.path;
    GltfOptions reading = a.reading;
    reading.leave_out_lobes = true; // they are compressed already
    GltfOptions options = reading;
    options.instancing = Instancing::separate; // each mesh once, as its transfer is stored
    GltfDocument document = a.baked.read(options);
    Scene scene = extract_scene(document);
    std::vector<FileInstance> instances;
    if (holds_instances(document))
        instances = instances_of(a, reading, scene);
    if (read_compressed_volume(document, scene))
        throw already_compressed(path);
    std::optional<BakedVolume> volume = read_volume(document, scene);
    discard_volume(document);
    Bake bake = bake_of_surfaces(std::move(document), std::move(scene), path, a.host.notify);
    about(path, [&] { check_instance_lamps(bake.stored.transfer.layout, instances); });
    bake.volume = std::move(volume);
    bake.instances = std::move(instances);
    return bake;
}

/// Number of probes per cluster, and minimum number of clusters: with more clusters, bases would need more
/// bytes than weights.
constexpr std::size_t kProbesOfCluster = 700, kMinClusters = 8;

std::optional<CompressedVolumeResult> compress_probes(const CompressWork& a, const Bake& bake) {
    if (!bake.volume && a.volume_bytes)
        throw Error("contains no volume, which --volume needs");
    if (!bake.volume)
        return std::nullopt;
    CompressOptions options;
    options.coding = preset_volume();
    options.coding.bits = 8 * a.volume_bytes.value_or(16) - options.coding.cluster_bits;
    options.clusters = static_cast<int>(
        std::clamp<std::size_t>(bake.volume->visibility.size() / kProbesOfCluster, kMinClusters, 256));
    options.bases_count = true;
    options.seed = a.options.compress.seed;
    options.threads = a.options.compress.threads;
    const Stage stage = a.host.stages("compressing the volume");
    return compress_volume(*bake.volume, options, stage.progress);
}

/// Weight of coarser levels. Clusters are optimised for level 0, and coarser levels are assigned to them.
constexpr float kShareOfCoarser = 1e-3f;

std::vector<float> areas_to_compress(const Bake& bake) {
    std::vector<float> areas = instanced_areas(bake.document, bake.scene);
    for (std::size_t p = bake.finest_receivers; bake.levels && p < areas.size(); ++p)
        areas[p] *= kShareOfCoarser;
    return areas;
}

/// Returns the areas and edges of the receivers for the compressor.
SceneSurface surface_of(const Bake& bake, const SearchOptions& options) {
    if (bake.lightmap) {
        SceneSurface surface;
        surface.areas = bake.lightmap->areas;
        surface.edges = lightmap_edges(bake.lightmap->layout, bake.lightmap->texels, bake.lightmap->seams);
        surface.jumps = seam_jumps(bake.scene, bake.lightmap->layout, bake.lightmap->texels);
        return surface;
    }
    SceneSurface surface(bake.scene);
    surface.areas = areas_to_compress(bake);
    const bool chooses = options.budget.any() && options.choose_predictors;
    if (!chooses && options.compress.predictors != PredictorChoice::normal_and_position)
        surface.positions = {};
    return surface;
}

Outcome run_compressor(const CompressWork& a, const TransferView& transfer, const ReceiverSurface& surface,
                       const SearchOptions& options) {
    const CompressOptions& o = options.compress;
    const Stage stage = a.host.stages("compressing");
    if (a.preset) {
        SearchResult found = compress_preset(transfer, surface, o, stage.progress);
        return {std::move(found.result), std::move(found.trials), {}};
    }
    if (!options.budget.any())
        return {compress(transfer, surface, o, stage.progress), {}, {}};
    SearchResult found = compress_within(transfer, surface, options, stage.progress);
    if (!found.kept && !a.best_effort) {
        throw Error(a.baked.string() + ": no result meets the goal; the closest has " +
                    in_words(found.result.statistics, transfer.receivers()) + "; " +
                    in_words(promises_of(options.budget, found.best)) + " (--best-effort writes it)");
    }
    return {std::move(found.result), std::move(found.trials), found.best};
}

BufferCompression buffer_compression(const CompressWork& a) {
    return a.writing.meshopt ? BufferCompression::meshopt : BufferCompression::none;
}

/// Returns the bake's file with the result, in the requested order.
std::vector<std::byte> encoded(const CompressWork& a, Bake bake, Scene& scene, ClusteredTransfer compressed) {
    GltfDocument& document = bake.document;
    const BufferCompression buffers = buffer_compression(a);
    if (bake.lightmap) {
        bake.lightmap->baked.record = bake.stored.record;
        write_encoded_lightmap(document, scene,
                               encoded_lightmap(scatter_to_maps(*bake.lightmap, std::move(compressed))));
        return encode_glb(document, buffers);
    }
    CompressedTransfer result{std::move(compressed), bake.stored.record};
    if (a.writing.reorder) {
        const std::vector<std::uint32_t> order = order_by_cluster(scene, result.transfer.receivers);
        reorder_vertices(document, scene, order);
        result.transfer.receivers = reordered(result.transfer.receivers, order);
    }
    write_clustered(document, scene, result);
    result = {}; // the document has a copy; this frees memory for the file
    for (Primitive& primitive : scene.primitives)
        primitive.triangles = {}; // only vertices are compared with the written file
    return encode_glb(document, buffers);
}

struct Written {
    Scene scene;
    ClusteredTransfer transfer; ///< transfer of the bake's receivers, in the order of the file
    std::vector<float> areas;
    std::vector<Edge> edges;
    std::uintmax_t bytes;                               ///< file size
    std::vector<std::vector<float>> coarser_areas = {}; ///< [coarser levels][receivers]
};

/// Edges of the mesh between the first `count` receivers.
std::vector<Edge> edges_within(const Scene& scene, std::size_t count) {
    std::vector<Edge> edges = mesh_edges(scene);
    std::erase_if(edges, [&](const Edge& edge) { return edge.first >= count || edge.second >= count; });
    return edges;
}

/// Adds errors of coarser levels against their baked transfer, over their surfaces.
void add_levels_compressed(const TransferView& transfer, const Written& written, Report& report) {
    if (written.coarser_areas.empty())
        return;
    Json list = Json::array();
    for (std::size_t level = 1; level <= written.coarser_areas.size(); ++level) {
        const std::vector<float>& areas = written.coarser_areas[level - 1];
        list.push_back({{"level", level},
                        {"vertices", std::ranges::count_if(areas, [](float area) { return area > 0; })},
                        {"relative_l2", relative_l2(transfer, written.transfer, areas)}});
        report.sentences.push_back(
            fmt::format("level of detail {{levels/{0}/level}} by the same clusters: {{levels/{0}/vertices}} "
                        "vertices, transfer (relative L2) {{levels/{0}/relative_l2:.3f%}}; the errors above "
                        "are of level 0",
                        level - 1));
    }
    add_figures(report, {{"levels", std::move(list)}});
}

/// Calls `read`, which reads the written file before it is published, and explains its errors.
template <class Read>
auto readable(const CompressWork& a, Read&& read) {
    try {
        return read();
    } catch (const Error& error) {
        throw Error(a.baked.string() + ": cannot be compressed: a reader would reject " + error.what());
    }
}

/// Stages the file and reads it back; its bytes are freed after parsing.
Written written(const CompressWork& a, std::vector<std::byte> file, const Bake& bake) {
    const std::optional<BakedLightmap>& lightmap = bake.lightmap;
    GltfDocument document = readable(a, [&] {
        return parse_gltf(file, a.output,
                          {.instancing = Instancing::separate,
                           .leave_out_lobes = true,
                           .scene_limit = a.reading.scene_limit});
    });
    const std::uintmax_t bytes = a.host.write(a.output, file);
    file = {};
    SceneFile read = readable(a, [&] { return scene_file_of(std::move(document), a.output, a.host.notify); });
    ClusteredTransfer& transfer = read.compressed->transfer;
    if (lightmap)
        return {std::move(read.scene), gather_texels(transfer, lightmap->texels), lightmap->areas,
                lightmap_edges(lightmap->layout, lightmap->texels, lightmap->seams), bytes};
    if (bake.levels) {
        LeveledScene levels = extract_levels(read.document);
        ClusteredTransfer all = std::move(read_clustered(read.document, levels.scene)->transfer);
        std::vector<float> areas = instanced_areas(read.document, levels.scene);
        std::fill(areas.begin() + static_cast<std::ptrdiff_t>(levels.finest_receivers), areas.end(), 0.0f);
        std::vector<std::vector<float>> coarser;
        for (std::size_t level = 1; level <= levels.deepest(); ++level)
            coarser.push_back(areas_of_level(levels, level));
        std::vector<Edge> edges = edges_within(levels.scene, levels.finest_receivers);
        return {std::move(levels.scene), std::move(all), std::move(areas),
                std::move(edges),        bytes,          std::move(coarser)};
    }
    std::vector<float> areas = instanced_areas(read.document, read.scene);
    std::vector<Edge> edges = mesh_edges(read.scene);
    return {std::move(read.scene), std::move(transfer), std::move(areas), std::move(edges), bytes};
}

Json trials_json(const std::vector<SearchTrial>& trials) {
    Json list = Json::array();
    for (const SearchTrial& trial : trials)
        list.push_back(trial_json(trial));
    return list;
}

/// "normal", "normal, position" or "none"
std::string predictors_in_words(const ClusteredBases& bases) {
    return bases.predictors.empty() ? "none" : fmt::format("{}", fmt::join(predictor_names(bases), ", "));
}

/// Returns the figures of a result. Errors are those of the written file, against `transfer` in its order.
Json result_json(const CompressStatistics& s, const CompressOptions& options, const TransferView& transfer,
                 const Written& written) {
    const std::vector<float>& areas = written.areas;
    const std::vector<Edge>& edges = written.edges;
    const std::size_t receivers = transfer.receivers();
    const std::size_t uncompressed = transfer.dimension() * sizeof(float);
    const ClusteredBases& bases = written.transfer.bases;
    return {{"order", transfer.layout().order},
            {"channels", transfer.layout().channels()},
            {"terms", terms_figures(transfer.layout())},
            {"receivers", receivers},
            {"clusters", s.clusters},
            {"components_max", bases.max_components()},
            {"components_mean", s.mean_components},
            {"predictors", predictors_in_words(bases)},
            {"shader_operations", s.operations()},
            {"jump_across_clusters",
             ClusterJumps(transfer, {areas, edges}, *options.metric, options.threads)
                 .percentile_99(written.transfer, written.transfer.receivers.cluster_indices())},
            {"relative_l2", relative_l2(transfer, written.transfer, areas)},
            {"lit_rms_by_iteration", s.lit_rms_by_iteration},
            {"bytes_bound_per_vertex", s.bytes_per_receiver},
            {"bytes_bound_per_vertex_with_bases", s.bytes_with_bases(receivers)},
            {"bits_used_per_vertex", s.bits_per_receiver},
            {"bytes_uncompressed_per_vertex", uncompressed},
            {"bytes_attributes", s.bytes_per_receiver * receivers},
            {"bytes_bases", s.basis_bytes},
            {"bytes_constants", constant_rows(bases) * sizeof(glm::vec4)},
            {"bytes_ram", ClusterLighting(written.transfer).matrix().size_bytes()},
            {"bytes_uncompressed", uncompressed * receivers}};
}

Json reuse_json(const VertexReuse& before, const VertexReuse& after) {
    return {{"vertices_transformed_per_triangle", after.transforms_per_triangle},
            {"vertices_transformed_per_triangle_before", before.transforms_per_triangle},
            {"vertex_overfetch", after.overfetch},
            {"vertex_overfetch_before", before.overfetch}};
}

/// Which limit decided the result, the figures of all limits, and the skies that they hold for.
void add_promises(const SearchOptions& options, const SearchTrial& best, const std::string& covers,
                  Report& report) {
    const std::vector<PromiseKept> promises = promises_of(options.budget, best);
    Json list = Json::array();
    for (const PromiseKept& kept : promises)
        list.push_back({{"option", words_of(kept.promise).option},
                        {"figure", words_of(kept.promise).what},
                        {"reached", kept.reached},
                        {"limit", kept.limit}});
    add_figures(report, {{"decided_by", words_of(promises.front().promise).option},
                         {"promises", std::move(list)},
                         {"promises_cover", covers}});
    if (options.budget.max_error)
        add_figures(report, {{"worst_lit_rms_promised", best.worst_lit_rms}});
    std::string sentence = "decided by " + in_words(promises.front());
    if (promises.size() > 1)
        sentence += "; " + in_words(std::span(promises).subspan(1));
    report.sentences.push_back(std::move(sentence));
    if (options.budget.max_error || options.budget.max_jump)
        report.sentences.push_back(covers);
}

std::vector<std::string> sentences(const CompressWork& a, bool fitted) {
    std::vector<std::string> list = {
        "{output}: {clusters} clusters x {components_mean:.2f} components, predictors: {predictors}"};
    if (fitted)
        list.push_back(
            fmt::format("the mesh is small: {} fitted to it, so that bases do not outweigh weights",
                        a.options.compress.coding.format == WeightFormat::packed ? "clusters and bits are"
                                                                                 : "clusters are"));
    list.emplace_back(
        "expected error of the lit surface (lit_rms) {lit_rms:.3f%}, of the transfer (relative "
        "L2) {relative_l2:.3f%}; jumps between clusters are at most "
        "{jump_across_clusters:.2f%} of the visible radiance on 99 % of the borders, on average over skies");
    list.emplace_back(
        "{bytes_bound_per_vertex} bytes per vertex to bind ({bits_used_per_vertex} bits in use), "
        "{bytes_bound_per_vertex_with_bases:.2f} with the bases; uncompressed "
        "{bytes_uncompressed_per_vertex}");
    list.emplace_back(
        "GPU: {bytes_attributes} bytes of attributes, {bytes_constants} of constants per lighting; RAM: "
        "{bytes_ram} of bases, which need {bytes_bases} on disk; uncompressed {bytes_uncompressed}");
    if (a.writing.reorder)
        list.emplace_back(
            "vertices transformed per triangle {vertices_transformed_per_triangle:.3f}, before "
            "{vertices_transformed_per_triangle_before:.3f}; fetched {vertex_overfetch:.2f} times, before "
            "{vertex_overfetch_before:.2f}");
    list.emplace_back("{bytes_file} bytes on disk; {seconds:.2f} s");
    return list;
}

/// Returns all figures except errors under skies.
Report report_of(const CompressWork& a, const SearchOptions& options, const std::string& covers,
                 const TransferView& transfer, const Outcome& outcome, const Written& result) {
    const CompressStatistics& s = outcome.result.statistics;
    Report report;
    add_figures(report, {{"output", a.output.string()}});
    add_figures(report, result_json(s, options.compress, transfer, result));
    add_figures(
        report,
        {{"bytes_file", result.bytes}, {"trials", trials_json(outcome.trials)}, {"seconds", s.seconds}});
    report.sentences = sentences(a, a.preset && !outcome.trials.empty());
    if (s.sky_contrast > 0) {
        add_figures(report, {{"sky_contrast", s.sky_contrast}});
        report.sentences.emplace_back("contrast error of the light of skies: {sky_contrast:.2%} ("
                                      "root mean square)");
    }
    if (s.lamp_contrast > 0) {
        add_figures(report, {{"lamp_contrast", s.lamp_contrast}});
        report.sentences.emplace_back("contrast error of lamps, with one lit at a time: {lamp_contrast:.2%} "
                                      "(root mean square over all lamps)");
    }
    if (outcome.best)
        add_promises(options, *outcome.best, covers, report);
    return report;
}

void add_levels_and_instances(const Bake& bake, const TransferView& transfer, const Written& result,
                              Report& report) {
    add_levels_compressed(transfer, result, report);
    if (!bake.instances.empty())
        add_instance_constants(relit_instances(bake.instances, result.scene, result.transfer),
                               {{"count", bake.instances.size()}}, report);
}

/// Checks the options for texels: a pass over a map has no normals, and its words are packed.
void choose_for_texels(const CompressWork& a, SearchOptions& options) {
    if (a.predictors_given && options.compress.predictors != PredictorChoice::none)
        throw Error("--predictors does not support lightmaps: texels have no normals and positions; use "
                    "--predictors none");
    if (options.compress.coding.format != WeightFormat::packed)
        throw Error("--bits float does not support lightmaps: weights of texels are integers");
    if (a.writing.reorder)
        throw Error("--reorder does not support lightmaps: it changes the order of vertices");
    if (!a.writing.fallback.empty())
        throw Error("--fallback does not support lightmaps: it writes vertex colors; bake without --texels");
    options.compress.predictors = PredictorChoice::none;
    options.choose_predictors = false;
}

/// Returns the data for writing a file; the transfer is not moved.
Bake bake_without_transfer(Bake& bake) {
    return {std::move(bake.document), {{}, bake.stored.record}, {}, bake.lightmap};
}

void check_components(const CompressWork& a, const TransferView& transfer) {
    const int asked = a.options.compress.coding.components;
    if (a.components_given && !a.options.choose_components && asked > static_cast<int>(transfer.dimension()))
        throw Error(fmt::format("--components must be in 0..{}, the length of a transfer vector, not {}",
                                transfer.dimension(), asked));
}

/// Adds errors under the metric, under `skies`, and under the standard skies.
void add_errors(const ErrorMoments& moments, const LightMetric& metric, std::vector<LightingUses> skies,
                Report& report) {
    add_figures(report, {{"lit_rms", expected_lit_rms(moments, metric)}});
    std::ranges::move(uses_of(standard_skies(metric.layout.order), metric.layout), std::back_inserter(skies));
    add_sky_errors(moments, skies, report);
}

} // namespace

Report compress_model(CompressRequest request, const Host& host) {
    const CompressWork a{std::move(request), host};
    Bake bake = load_bake(a);
    TransferView transfer = bake.stored.transfer;
    if (a.writing.whole)
        transfer = as_combined(std::move(transfer));
    SearchOptions options = a.options;
    if (bake.lightmap)
        choose_for_texels(a, options);
    const int threads = options.compress.threads;
    std::optional<Fallback> fallback =
        load_fallback(a.writing.fallback, transfer.layout().order, a.metric.light_options, threads);
    if (fallback && holds_instances(bake.document))
        throw Error(a.baked.string() +
                    ": --fallback does not support shared instances: it writes vertex colors; bake with "
                    "--instances own");
    std::optional<SceneSurface> surface = surface_of(bake, options);
    std::vector<LightingUses> skies = given_lights(a.metric, transfer.layout(), threads);
    ErrorTerms terms = error_terms(a.metric, skies, transfer, surface->areas, threads);
    options.compress.metric = std::move(terms.metric);
    promise(terms, options.budget);
    check_components(a, transfer);
    std::string trace;
    if (!a.trace.empty())
        options.compress.trace = [&](const CompressEvent& event) { trace += trace_line(event); };
    Outcome outcome = run_compressor(a, transfer, surface->view(), options);
    surface.reset();
    a.host.write(a.trace, std::as_bytes(std::span(trace)));
    Scene scene = std::move(bake.scene);
    const VertexReuse reuse_before = vertex_reuse(scene);
    const std::optional<BakedLightmap> texels = bake.lightmap;
    const std::optional<CompressedVolumeResult> volume =
        about(a.baked.path, [&] { return compress_probes(a, bake); });
    std::vector<std::byte> file = about(a.baked.path, [&] {
        if (volume)
            write_volume(bake.document, scene, volume->volume);
        return encoded(a, bake_without_transfer(bake), scene, std::move(outcome.result.transfer));
    });
    if (fallback)
        file = with_fallback(file, a.baked.path, *fallback, buffer_compression(a), threads);
    if (!a.writing.reorder)
        scene = {}; // vertices are in their original order
    const Written result = written(a, std::move(file), bake);
    if (a.writing.reorder) {
        transfer = in_order(std::move(transfer), matching_receivers(result.scene, scene));
        scene = {};
    }
    Report report = report_of(a, options, terms.covers, transfer, outcome, result);
    add_figures(report, reuse_json(reuse_before, vertex_reuse(result.scene)));
    add_errors(error_moments(transfer, result.transfer, result.areas, threads), *options.compress.metric,
               std::move(skies), report);
    report_fallback(fallback, report);
    add_levels_and_instances(bake, transfer, result, report);
    if (volume)
        add_volume_compression(volume->statistics, volume->volume, report);
    if (texels)
        report_texels(report);
    return report;
}

} // namespace prt::pipeline
