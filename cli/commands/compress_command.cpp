#include "commands/commands.h"

#include "inputs.h"
#include "outputs.h"
#include "prt/error_measures.h"
#include "prt/reorder.h"
#include "prt/search.h"
#include "prt/support/error.h"
#include "report/write_report.h"

#include <fmt/core.h>

#include <filesystem>

namespace prt::cli {
namespace {

LightMetric chosen_metric(const CompressArguments& a, const Transfer& transfer) {
    if (a.lights.empty())
        return a.metric == MetricChoice::plain ? plain_metric(transfer.order, transfer.channels)
                                               : natural_metric(transfer.order, transfer.channels);
    std::vector<Light> lights;
    for (const Path& path : a.lights)
        lights.push_back(load_light(path, transfer.order, a.light_options, a.options.compress.threads).light);
    return metric_of_lights(lights, transfer.order, transfer.channels);
}

/// "error 0.012, 5.1 bytes per vertex, 6.2 shader operations"
std::string in_words(const CompressStatistics& s, std::size_t receivers) {
    return fmt::format("lit_rms {:.4g}, {:.2f} bytes per vertex, {:.2f} shader operations", s.lit_rms,
                       s.bytes_with_bases(receivers), s.mean_components);
}

struct Outcome {
    CompressResult result;
    std::vector<SearchTrial> trials;
};

Outcome run_compressor(const CompressArguments& a, const Model& model, const SearchOptions& options,
                       Interrupt& interrupt) {
    const Transfer& transfer = model.baked->transfer;
    const std::vector<float> areas = receiver_areas(model.scene);
    const CompressOptions& o = options.compress;
    const std::vector<Edge> edges =
        o.seam_price > 0 || o.border_price > 0 ? mesh_edges(model.scene) : std::vector<Edge>{};
    ProgressBar bar("compressing", interrupt.token());
    if (a.preset) {
        SearchResult found = compress_preset(transfer, areas, edges, o, bar.progress());
        return {std::move(found.result), std::move(found.trials)};
    }
    if (!options.budget.any())
        return {compress(transfer, areas, edges, o, bar.progress()), {}};
    SearchResult found = compress_within(transfer, areas, edges, options, bar.progress());
    if (!found.kept && !a.best_effort)
        throw Error(a.baked.string() + ": nothing keeps the budget; the nearest has " +
                    in_words(found.result.statistics, transfer.receivers()) + " (--best-effort writes it)");
    return {std::move(found.result), std::move(found.trials)};
}

Json trials_json(const std::vector<SearchTrial>& trials) {
    Json list = Json::array();
    for (const SearchTrial& t : trials)
        list.push_back({{"clusters", t.clusters},
                        {"bytes_bound_per_vertex", t.payload_bytes},
                        {"lit_rms", t.lit_rms},
                        {"bytes_bound_per_vertex_with_bases", t.bytes_per_vertex},
                        {"shader_operations", t.mean_components}});
    return list;
}

} // namespace

void run(const CompressArguments& a, Interrupt& interrupt) {
    std::vector<Path> inputs = a.lights;
    inputs.push_back(a.baked);
    check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}}, inputs);
    Model model = load_model(a.baked);
    if (!model.baked)
        throw Error(a.baked.string() + (model.compressed
                                            ? ": is compressed already; compress the bake it came from"
                                            : ": holds no transfer; run prt bake first"));
    const Transfer& transfer = model.baked->transfer;
    SearchOptions options = a.options;
    options.compress.metric = chosen_metric(a, transfer);
    if (a.components_given && options.compress.coding.components > static_cast<int>(transfer.dimension()))
        throw Error(fmt::format("components must lie in 0..{}, the dimension of the transfer vectors, not {}",
                                transfer.dimension(), options.compress.coding.components));
    discard_transfer(model.document); // it is in `transfer`, and would be in memory twice
    Outcome outcome = run_compressor(a, model, options, interrupt);
    ClusteredTransfer& result = outcome.result.transfer;
    const VertexReuse reuse_before = vertex_reuse(model.scene);
    if (a.reorder) {
        const std::vector<std::uint32_t> order = order_by_cluster(model.scene, result.receivers);
        reorder_vertices(model.document, model.scene, order);
        result.receivers = reordered(result.receivers, order);
    }
    write_clustered(model.document, model.scene, {result, model.baked->record});
    {
        const Interrupt::WritingScope writing(interrupt);
        save_glb(model.document, a.output, a.meshopt ? BufferCompression::meshopt : BufferCompression::none);
    }
    // The figures are those of the file, not of what was meant to be written.
    const Model written = load_model(a.output);
    put_in_order_of(written.scene, model);
    const VertexReuse reuse = vertex_reuse(written.scene);
    const ClusteredTransfer& coded = written.compressed->transfer;
    const Transfer decoded = decode(coded, options.compress.threads);
    const std::vector<float> areas = receiver_areas(written.scene);
    CompressStatistics s = outcome.result.statistics;
    s.lit_rms =
        expected_lit_rms(transfer, decoded, areas, *options.compress.metric, options.compress.threads);
    const double l2 = relative_l2(transfer, decoded, areas);

    const std::size_t receivers = transfer.receivers();
    const std::size_t uncompressed = transfer.dimension() * sizeof(float);
    const std::size_t constants = constant_rows(coded.bases) * sizeof(glm::vec4);
    fmt::print("{}: {} clusters x {:.2f} components\n", a.output.string(), s.clusters, s.mean_components);
    if (a.preset && !outcome.trials.empty())
        fmt::print("  the mesh is small: {} fitted to it, so that bases do not outweigh weights\n",
                   options.compress.coding.format == WeightFormat::packed ? "clusters and bits are"
                                                                          : "clusters are");
    fmt::print(
        "  expected error of the lit surface (lit_rms) {:.3f} %, of the transfer (relative L2) {:.3f} %\n",
        100 * s.lit_rms, 100 * l2);
    fmt::print("  {} bytes per vertex to bind ({} bits in use), {:.2f} with the bases; uncompressed {}\n",
               s.bytes_per_receiver, s.bits_per_receiver, s.bytes_with_bases(receivers), uncompressed);
    fmt::print("  GPU: {} bytes of attributes, {} of bases, {} of constants per lighting; uncompressed {}\n",
               s.bytes_per_receiver * receivers, s.basis_bytes, constants, uncompressed * receivers);
    if (a.reorder)
        fmt::print("  vertices transformed per triangle {:.3f}, before {:.3f}; fetched {:.2f} times, before "
                   "{:.2f}\n",
                   reuse.transforms_per_triangle, reuse_before.transforms_per_triangle, reuse.overfetch,
                   reuse_before.overfetch);
    fmt::print("  {} bytes on disk; {:.2f} s\n", std::filesystem::file_size(a.output), s.seconds);
    write_json({{"output", a.output.string()},
                {"order", transfer.order},
                {"channels", transfer.channels},
                {"receivers", receivers},
                {"clusters", s.clusters},
                {"components_most", coded.bases.max_components()},
                {"components_mean", s.mean_components},
                {"lit_rms", s.lit_rms},
                {"relative_l2", l2},
                {"lit_rms_by_iteration", s.lit_rms_by_iteration},
                {"bytes_bound_per_vertex", s.bytes_per_receiver},
                {"bytes_bound_per_vertex_with_bases", s.bytes_with_bases(receivers)},
                {"bits_used_per_vertex", s.bits_per_receiver},
                {"bytes_uncompressed_per_vertex", uncompressed},
                {"bytes_attributes", s.bytes_per_receiver * receivers},
                {"bytes_bases", s.basis_bytes},
                {"bytes_constants", constants},
                {"bytes_uncompressed", uncompressed * receivers},
                {"vertices_transformed_per_triangle", reuse.transforms_per_triangle},
                {"vertices_transformed_per_triangle_before", reuse_before.transforms_per_triangle},
                {"vertex_overfetch", reuse.overfetch},
                {"vertex_overfetch_before", reuse_before.overfetch},
                {"bytes_file", std::filesystem::file_size(a.output)},
                {"trials", trials_json(outcome.trials)},
                {"seconds", s.seconds}},
               a.json, interrupt);
}

} // namespace prt::cli
