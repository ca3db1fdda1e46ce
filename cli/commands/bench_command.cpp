// prt bench: measures speed and error of bakes.

#include "cli/commands/commands.h"

#include "bake/device/gpu_devices.h"
#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "cli/pipeline/model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "cli/report/bench_report.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

struct BenchArguments {
    Path scene;
    ReportFiles files;
    BenchOptions options;
    ReadingOptions reading;
    bool list_devices = false;
};

std::string in_words(const GpuDevice& device) {
    if (!device.missing_feature.empty())
        return fmt::format("{}; cannot bake: no {}", device.name, device.missing_feature);
    return fmt::format("{}; {}; {}, {}, {:.1f} GB of memory", device.name, device.driver,
                       device.hardware ? "hardware" : "software",
                       device.ray_queries ? "ray queries" : "no ray queries", device.memory / 1e9);
}

void print_devices() {
    const std::vector<GpuDevice> devices = gpu_devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        fmt::print("{}: {}\n", i, in_words(devices[i]));
    if (devices.empty())
        fmt::print("no GPU: no driver for Vulkan is installed\n");
}

Report scene_report(const BenchArguments& a, Session& session) {
    const GltfDocument document = load_gltf(a.scene, a.reading);
    const Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);
    ProgressBar bar = session.progress_bar("measuring");
    Report report = bench_report(
        about(a.scene, [&] { return run_bench(a.scene.string(), scene, a.options, bar.progress()); }));
    report.notices = scene.notices;
    return report;
}

void run(BenchArguments a, Session& session) {
    if (a.list_devices && !(a.files.json.empty() && a.files.html.empty() && a.files.csv.empty()))
        throw CLI::ValidationError("--device", "list writes no report");
    if (a.list_devices)
        return print_devices();
    if (!a.options.gpu.empty())
        named_device(gpu_devices(), a.options.gpu); // throws before the CPU has run
    if (a.scene.empty())
        throw CLI::RequiredError("scene or --device list");
    a.options.bad_textures = a.reading.bad_textures;
    a.reading.outputs = check_outputs({{a.files.json, "--json", {".json"}},
                                       {a.files.html, "--report", {".html", ".htm"}},
                                       {a.files.csv, "--report", {".csv"}}},
                                      {a.scene});
    Report report = scene_report(a, session);
    report.origin.emplace_back("command", session.command_line());
    const std::vector<GpuDevice> devices = gpu_devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        report.origin.emplace_back(fmt::format("GPU {}", i), in_words(devices[i]));
    publish(report, a.files, session);
}

void set_rays(const std::string& text, BenchOptions& options) {
    const std::size_t dots = text.find("..");
    const int from = whole_number(text.substr(0, dots)).value_or(0),
              to = dots == std::string::npos ? 0 : whole_number(text.substr(dots + 2)).value_or(0);
    if (from < 1 || from > to || to > kMaxRays / 64)
        throw CLI::ValidationError(
            "--rays", fmt::format("'{}' is not FROM..TO with 1 <= FROM <= TO <= {}", text, kMaxRays / 64));
    options.fewest_rays = from;
    options.max_rays = to;
}

void add_bench_device(CLI::App* command, BenchArguments& a, CLI::Option* scene) {
    command
        ->add_option_function<std::string>(
            "--device",
            [&a, scene](const std::string& text) {
                a.list_devices = text == "list";
                if (a.list_devices && scene->count() > 0)
                    throw CLI::ValidationError("--device", "list does not bake: omit the scene");
                if (text.empty())
                    throw CLI::ValidationError("--device", "the name is empty");
                a.options.gpu = a.list_devices ? "" : text;
            },
            "GPU that traces rays, in addition to the CPU; default: automatic\n"
            "N: the GPU with this number in the list of --device list\n"
            "NAME: the only GPU whose name in the list contains NAME, in upper or lower case\n"
            "  an error if no GPU or more than one GPU matches\n"
            "list: print the list of GPUs and exit; not with a scene, --json or --report\n"
            "default: a hardware GPU before a software driver, then the one with the largest memory\n"
            "  without a GPU, its runs are skipped; no effect on depth maps, which OpenGL draws")
        ->type_name("N|NAME|list");
}

} // namespace

void add_bench(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("bench", "Measure speed and error of bakes on all devices and by all methods");
    auto& a = arguments_for<BenchArguments>(command,
                                            [&session](const BenchArguments& given) { run(given, session); });
    CLI::Option* scene = command
                             ->add_option("scene", a.scene,
                                          "scene to bake: .gltf, .glb, .obj or .ply\n"
                                          "                              omit only with --device list")
                             ->check(named);
    add_bench_device(command, a, scene);
    command->add_option("--order", a.options.order, "SH order N of the transfer, 1 to 10: N² coefficients")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    command
        ->add_option_function<std::string>(
            "--rays", [&a](const std::string& text) { set_rays(text, a.options); },
            "rays per vertex: FROM, doubled in each next run up to TO\n"
            "1 to 262144, FROM at most TO; with depth maps: number of directions\n"
            "the reference of the error has 64 times TO rays")
        ->type_name("FROM..TO")
        ->default_str(fmt::format("{}..{}", a.options.fewest_rays, a.options.max_rays));
    Suboptions("--method", "", "setting of the runs that use depth maps (prt bake --method raster)", nullptr)
        .whole_number("resolution", 16, 16384,
                      "number of texels along each side of a depth map, 16 to 16384 [1024]\n"
                      "  more than the GPU supports: these runs are omitted",
                      [&a](int texels) { a.options.raster_resolution = texels; })
        .add(command);
    command
        ->add_option("--seconds", a.options.max_seconds,
                     "skip runs that would take longer than X seconds\n"
                     "0 to 1e9; the time is estimated from the run before, with fewer rays\n"
                     "the first run of each method on each device is never skipped\n"
                     "the time of the reference and the total time are not limited")
        ->capture_default_str()
        ->check(real_in(0, 1e9));
    add_seed(command, a.options.seed);
    add_reading(command, a.reading);
    add_threads(command, a.options.threads);
    add_reports(command, a.files);
}

} // namespace prt::cli
