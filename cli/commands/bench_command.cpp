// prt bench: measures the speed of relighting.

#include "commands/commands.h"

#include "inputs.h"
#include "options.h"
#include "outputs.h"
#include "prt/gpu_devices.h"
#include "report/bench_report.h"

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
    if (!device.lacks.empty())
        return fmt::format("{}; cannot bake: no {}", device.name, device.lacks);
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
    if (a.list_devices)
        return print_devices();
    if (a.scene.empty())
        throw CLI::RequiredError("scene or --list-devices");
    a.options.bad_textures = a.reading.bad_textures;
    a.reading.outputs = check_outputs({{a.files.json, "--json", {".json"}},
                                       {a.files.html, "--html", {".html", ".htm"}},
                                       {a.files.csv, "--csv", {".csv"}}},
                                      {a.scene});
    Report report = scene_report(a, session);
    report.origin.emplace_back("command", session.command_line());
    const std::vector<GpuDevice> devices = gpu_devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        report.origin.emplace_back(fmt::format("GPU {}", i), in_words(devices[i]));
    publish(report, a.files, session);
}

} // namespace

void add_bench(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand(
        "bench", "Measure speed against error of the bake, on every backend and by every method");
    auto& a = arguments_for<BenchArguments>(command,
                                            [&session](const BenchArguments& given) { run(given, session); });
    CLI::Option* scene = command->add_option("scene", a.scene, "glTF 2.0 scene, .gltf or .glb")->check(named);
    command->add_flag("--list-devices", a.list_devices, "print the GPUs that bakes could run on, and end")
        ->excludes(scene);
    add_gpu(command, a.options.gpu);
    command->add_option("--order", a.options.order, "SH order N")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    command->add_option("--from", a.options.fewest_rays, "fewest rays per receiver")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxRays));
    command->add_option("--to", a.options.max_rays, "most rays per receiver")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxRays / 64));
    command
        ->add_option("--raster-resolution", a.options.raster_resolution,
                     "texels along each side of a depth map")
        ->capture_default_str()
        ->check(CLI::Range(16, 16384));
    command->add_option("--most-seconds", a.options.max_seconds, "leave runs out that would take longer")
        ->capture_default_str()
        ->check(real_in(0, 1e9));
    command->add_option("--seed", a.options.seed, "seed of the samples")
        ->capture_default_str()
        ->check(seed());
    add_reading(command, a.reading);
    add_threads(command, a.options.threads);
    add_reports(command, a.files);
}

} // namespace prt::cli
