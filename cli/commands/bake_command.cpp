#include "commands/commands.h"

#include "outputs.h"
#include "prt/gltf.h"
#include "prt/support/error.h"
#include "report/write_report.h"

#include <fmt/core.h>

#include <filesystem>

namespace prt::cli {

namespace {

Json statistics_json(const BakeStatistics& s) {
    return {{"receivers", s.receivers.all},
            {"receivers_traced", s.receivers.traced},
            {"back_sides", s.receivers.back_sides},
            {"receivers_sealed", s.receivers.sealed},
            {"receivers_refilled", s.receivers.refilled},
            {"triangles", s.triangles},
            {"rays", s.rays},
            {"device", s.device},
            {"seconds", s.seconds.all},
            {"seconds_build", s.seconds.build},
            {"seconds_trace", s.seconds.tracing.trace},
            {"seconds_accumulate", s.seconds.tracing.accumulate},
            {"seconds_transfer", s.seconds.tracing.transfer},
            {"seconds_transport", s.seconds.transport},
            {"rays_per_second", s.rays_per_second},
            {"mean_visibility", s.mean_visibility},
            {"sampling_error_relative_l2", s.sampling_error},
            {"float16_error_relative_l2", s.rounding_error},
            {"remaining_energy", s.remaining_energy},
            {"gather_entries", s.gather.entries},
            {"gather_bytes", s.gather.bytes},
            {"notices", s.notices}};
}

constexpr double kDark = 0.05; ///< mean visibility; a cellar with a window has as much

void print_report(const BakeArguments& a, const BakeResult& result) {
    const BakeStatistics& s = result.statistics;
    const Transfer& t = result.baked.transfer;
    const bool raster = a.options.tracer.method == BakeMethod::raster;
    fmt::print("{}: {} receivers, {} triangles, order {}, {} {}, {} {} each, {} bounces\n", a.output.string(),
               s.receivers.all, s.triangles, t.order, t.channels, t.channels == 1 ? "channel" : "channels",
               result.baked.record.rays, raster ? "directions" : "rays", result.baked.record.bounces);
    fmt::print("  {} on the {}: {}\n", raster ? "depth maps" : "rays",
               result.baked.record.backend == Backend::cpu ? "CPU" : "GPU", s.device);
    if (s.receivers.all > s.receivers.traced)
        fmt::print("  {} receivers are on no surface and have zero transfer\n",
                   s.receivers.all - s.receivers.traced);
    for (const std::string& notice : s.notices)
        fmt::print("  {}\n", notice);
    fmt::print("  {:.3f} s: build {:.3f}, trace {:.3f}, accumulate {:.3f}, transfer {:.3f}, transport "
               "{:.3f}; {:.2f} "
               "million {}/s\n",
               s.seconds.all, s.seconds.build, s.seconds.tracing.trace, s.seconds.tracing.accumulate,
               s.seconds.tracing.transfer, s.seconds.transport, s.rays_per_second * 1e-6,
               raster ? "tests" : "rays");
    if (a.options.target_error)
        fmt::print("  error of the direct light: {:.3f} % asked for, {:.3f} % estimated\n",
                   100 * *a.options.target_error, 100 * s.sampling_error);
    else if (s.sampling_error > 0)
        fmt::print("  error of the direct light: {:.3f} % estimated\n", 100 * s.sampling_error);
    if (s.gather.entries > 0)
        fmt::print("  bounces: {} pairs of receivers that light each other, {:.1f} MB; at most {:.2g} % of a "
                   "receiver's light is missing\n",
                   s.gather.entries, static_cast<double>(s.gather.bytes) * 1e-6, 100 * s.remaining_energy);
    fmt::print("  {:.1f} % of the light of a uniform sky arrives, on average\n", 100 * s.mean_visibility);
    if (s.mean_visibility < kDark && a.no_shadow.empty())
        fmt::print("  hardly any light comes in: where a shell round the scene, as an outline or a sky, "
                   "keeps it out, "
                   "--no-shadow MATERIAL lets it pass\n");
}

/// Surfaces of these materials stop no light.
void leave_out_shadows(Scene& scene, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        bool found = false;
        for (Material& material : scene.materials)
            if (material.name == name) {
                material.casts_shadow = false;
                found = true;
            }
        if (!found)
            throw Error("no material is called '" + name + "'");
    }
}

} // namespace

void run(const BakeArguments& a, Interrupt& interrupt) {
    check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}}, {a.scene});
    const auto missing =
        a.options.bad_textures == BadTextures::ignore ? MissingImages::ignore : MissingImages::error;
    GltfDocument document = load_gltf(a.scene, missing);
    Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);

    BakeResult result;
    try {
        leave_out_shadows(scene, a.no_shadow);
        ProgressBar bar("baking", interrupt.token());
        result = bake(scene, a.options, bar.progress());
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw Error(a.scene.string() + ": " + error.what());
    }
    write_transfer(document, scene, result.baked);
    {
        const Interrupt::WritingScope writing(interrupt);
        save_glb(document, a.output);
    }
    print_report(a, result);
    Json report = {{"output", a.output.string()},
                   {"order", a.options.order},
                   {"channels", result.baked.transfer.channels},
                   {"storage", result.baked.storage == TransferStorage::float16 ? "float16" : "float32"},
                   {"bake", bake_record_json(result.baked.record)}};
    if (a.options.target_error)
        report["target_error_relative_l2"] = *a.options.target_error;
    report.update(statistics_json(result.statistics));
    for (const std::string& notice : scene.notices)
        report["notices"].push_back(notice);
    report["bytes_file"] = std::filesystem::file_size(a.output);
    write_json(report, a.json, interrupt);
}

} // namespace prt::cli
