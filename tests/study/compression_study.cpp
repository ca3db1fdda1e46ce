// Measures error at equal bytes and at equal shader operations: the methods of `prt evaluate --measure
// sweep`, and two methods of research: a moving basis (Silvennoinen and Sloan 2021) and residual vector
// quantisation (Chen, Guan and Wang 2010).
//      compression_study BAKED.glb [--lights SKY]... [--json FILE]

#include "cli/report/sweep_report.h"
#include "moving_basis_candidates.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/gltf/gltf.h"
#include "prt/image/image_file.h"
#include "residual_vq.h"
#include "runtime/core/support/file.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <optional>
#include <vector>

namespace prt {
namespace {

struct StudyArguments {
    std::filesystem::path baked, json;
    std::vector<std::filesystem::path> lights;
    int threads = 0; ///< 0: all
};

/// Returns the given lights, or the default ones of `prt evaluate`: a uniform light, an overcast sky and a
/// sun.
std::vector<Light> lights_of(const StudyArguments& arguments, int order) {
    std::vector<Light> lights;
    for (const std::filesystem::path& path : arguments.lights)
        lights.push_back(project(load_environment(path).environment, order, arguments.threads));
    if (!lights.empty())
        return lights;
    const Sun sun{glm::normalize(glm::vec3(0.5f, 1, 0.7f)), glm::vec3(1)};
    return {constant_light(order, glm::vec3(1)), overcast_sky(order, glm::vec3(1)), as_light(sun, order)};
}

/// One line on the terminal. Keeps a reference to `shown`, the per cent that it shows: parts of the progress
/// are copies that share it.
Progress progress_line(int& shown) {
    return {[&shown](double share) {
                const int percent = static_cast<int>(100 * share);
                if (percent == shown)
                    return;
                shown = percent;
                fmt::print(stderr, "\rsweeping {} %", percent);
                if (percent == 100)
                    fmt::print(stderr, "\n");
                std::fflush(stderr);
            },
            {}};
}

Sweep run_sweep(const StudyArguments& arguments) {
    const GltfDocument document = load_gltf(arguments.baked);
    const Scene scene = extract_scene(document);
    const std::optional<BakedTransfer> baked = read_transfer(document, scene);
    if (!baked)
        throw Error(arguments.baked.string() + ": holds no raw transfer of vertices; run prt bake");
    const Transfer& transfer = baked->transfer;
    const SceneSurface surface(scene);
    CompressOptions options;
    options.threads = arguments.threads;
    std::vector<SweepCandidate> others = residual_vq_candidates(transfer, options.seed);
    std::vector<SweepCandidate> moving = moving_basis_candidates(transfer, surface.view(), arguments.threads);
    std::move(moving.begin(), moving.end(), std::back_inserter(others));
    int shown = -1;
    return sweep(transfer, surface.view(), lights_of(arguments, transfer.layout.order), options, others,
                 progress_line(shown));
}

void run(const StudyArguments& arguments) {
    cli::Report report;
    report.title = "Rate and distortion of " + arguments.baked.filename().string();
    report.origin = {{"baked", arguments.baked.string()}};
    for (const std::filesystem::path& path : arguments.lights)
        report.origin.emplace_back("light", path.string());
    cli::add_sweep(run_sweep(arguments), report);
    fmt::print("{}  At equal shader operations a moving basis has at most {} nodes.\n",
               cli::report_text(report), kSweepClusters);
    if (arguments.json.empty())
        return;
    OutputFile file(arguments.json);
    file.write(cli::json_text(cli::report_json(report)));
    file.commit();
}

} // namespace
} // namespace prt

int main(int argc, char** argv) {
    prt::StudyArguments arguments;
    CLI::App app("Error of prtkit, of published methods and of methods of research, at equal size and cost");
    app.add_option("baked", arguments.baked, "output of prt bake")->required();
    app.add_option("--lights", arguments.lights,
                   "environment (.exr, .hdr, .png, .jpg), repeated for each of several; otherwise a uniform "
                   "light, an overcast sky and a sun")
        ->allow_extra_args(false)
        ->type_name("SKY");
    app.add_option("--json", arguments.json, "write all points to this file")->type_name("FILE");
    app.add_option("--threads", arguments.threads, "0: all")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        prt::run(arguments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
    return 0;
}
