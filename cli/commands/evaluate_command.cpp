// prt evaluate: measures errors of a compressed file or of a bake.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/pipeline/comparison.h"
#include "cli/pipeline/evaluation_lights.h"
#include "cli/pipeline/level_errors.h"
#include "cli/pipeline/measure_budget.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/volume_errors.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "cli/report/of_texels.h"
#include "cli/report/sweep_report.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include <filesystem>
#include <set>

namespace prt::cli {
namespace {

enum class Measure { sweep, budget, volume };
constexpr Choice<Measure> kMeasures[] = {
    {"sweep", Measure::sweep,
     "error against bytes and shader cost, for several compression methods; takes minutes\n"
     "  compresses the first file"},
    {"budget", Measure::budget,
     "parts of the surface error by cause, with advice; path traces and bakes once more\n"
     "  if a second file is given, it must be compressed; not with --rotations above 1\n"
     "  not for bakes with subsurface scattering, --high-poly or --enclosed keep"},
    {"volume", Measure::volume,
     "error of the probe volume against path tracing, by distance from surfaces\n"
     "  the first file must contain a volume; if a second file is given, it must contain the\n"
     "  compressed volume\n"
     "  not with --rotations above 1"}};

struct EvaluateArguments {
    Path baked, shipped;
    ReportFiles files;
    std::vector<Path> lights;
    LightOptions light_options;
    SunCount suns = {std::nullopt};
    int rotations = 1; ///< number of rotations of each light about +Y
    std::set<Measure> measures;
    std::vector<std::string> no_shadow; ///< names of materials
    ReadingOptions reading;
    int threads = 0;
};

Sweep run_sweep(const EvaluateArguments& a, const SceneFile& baked, const std::vector<LoadedLight>& lights,
                Session& session) {
    std::vector<Light> all;
    for (const LoadedLight& light : lights)
        all.push_back(light.combined);
    CompressOptions options;
    options.threads = a.threads;
    ProgressBar bar = session.progress_bar("sweeping");
    const Transfer& transfer = baked.baked->transfer;
    const std::optional<SceneSurface> vertices =
        baked.lightmap ? std::nullopt : std::optional<SceneSurface>(baked.scene);
    const ReceiverSurface surface =
        vertices ? vertices->view() : ReceiverSurface{baked.lightmap->areas, baked.lightmap->edges};
    return sweep(transfer, surface, all, options, {}, bar.progress());
}

/// Returns the named lights, rotated as requested, or the default ones.
std::vector<LoadedLight> lights_of(const EvaluateArguments& a, int order) {
    std::vector<LoadedLight> lights;
    for (const Path& path : a.lights)
        for (LoadedLight& light :
             rotations(load_light(path, order, a.suns, a.light_options, a.threads), a.rotations))
            lights.push_back(std::move(light));
    return lights.empty() ? default_lights(order) : lights;
}

/// Returns a report with title and input files.
Report empty_report(const EvaluateArguments& a, const Session& session) {
    Report report;
    report.title = a.shipped.empty() ? "Rate and distortion of " + a.baked.filename().string()
                                     : a.shipped.filename().string() + " against its bake";
    report.origin = {{"baked", a.baked.string()}};
    if (!a.shipped.empty())
        report.origin.emplace_back("shipped", a.shipped.string());
    report.origin.emplace_back("command", session.command_line());
    return report;
}

void add_sizes_of_bake(const EvaluateArguments& a, const Transfer& transfer, Report& report) {
    report.figures.insert(
        report.figures.end(),
        {{{"receivers", "vertices"}, transfer.receivers()},
         {{"order", "order"}, transfer.layout.order},
         {{"channels", "channels"}, transfer.layout.channels()},
         {{"bytes_baked_per_vertex", "bytes per vertex, bake"}, transfer.dimension() * sizeof(float)},
         {{"bytes_file_baked", "bytes of the file, bake"},
          static_cast<std::size_t>(std::filesystem::file_size(a.baked))}});
}

std::vector<Path> check(const EvaluateArguments& a) {
    if (a.shipped.empty() && a.measures.empty())
        throw CLI::ValidationError(
            "evaluate",
            "a second file or --measure is missing; examples: prt evaluate BAKED.glb SHIPPED.glb; prt "
            "evaluate BAKED.glb --measure sweep; prt evaluate BAKED.glb --measure budget");
    if (a.rotations != 1 && (a.measures.contains(Measure::budget) || a.measures.contains(Measure::volume)))
        throw CLI::ValidationError("--rotations",
                                   "cannot be combined with --measure budget and volume; use --rotate");
    std::vector<Path> inputs = a.lights;
    inputs.insert(inputs.end(), {a.baked, a.shipped});
    return check_outputs({{a.files.json, "--json", {".json"}},
                          {a.files.html, "--report", {".html", ".htm"}},
                          {a.files.csv, "--report", {".csv"}}},
                         inputs);
}

BudgetRequest budget_request(const EvaluateArguments& a) {
    return {.baked = a.baked,
            .shipped = a.shipped,
            .reading = a.reading,
            .lights = {.files = a.lights,
                       .suns = a.suns,
                       .reading = a.light_options,
                       .order = {},
                       .separate = {},
                       .threads = a.threads},
            .no_shadow = a.no_shadow};
}

void run(EvaluateArguments a, Session& session) {
    a.reading.outputs = check(a);
    a.reading.leave_out_lobes = true; // prt lobes measures them
    SceneFile baked = load_scene_file(a.baked, a.reading);
    if (!baked.baked)
        throw Error(a.baked.string() +
                    ": contains no raw transfer; the first file must be the output of prt bake");
    if (has_lobes(baked.document) &&
        (a.measures.contains(Measure::budget) || a.measures.contains(Measure::volume)))
        throw Error(a.baked.string() + ": --measure budget and volume do not support files with lobes: they "
                                       "repeat the bake without the vertices that have lobes");
    const std::vector<LoadedLight> lights = lights_of(a, baked.baked->transfer.layout.order);
    Report report = empty_report(a, session);
    if (!a.shipped.empty())
        add_comparison({.baked = a.baked,
                        .shipped = a.shipped,
                        .reading = a.reading,
                        .pictures = !a.files.html.empty(),
                        .threads = a.threads},
                       baked, lights, report);
    if (!a.shipped.empty() && !baked.lightmap)
        add_level_errors({baked.document, a.baked, a.shipped, a.reading, a.threads}, lights, report);
    add_sizes_of_bake(a, baked.baked->transfer, report);
    if (a.measures.contains(Measure::budget))
        add_budget(budget_request(a), baked, report, session.host());
    if (a.measures.contains(Measure::volume))
        add_volume_errors(budget_request(a), baked, report, session.host());
    if (a.measures.contains(Measure::sweep))
        add_sweep(run_sweep(a, baked, lights, session), report);
    if (baked.lightmap)
        report_texels(report);
    publish(report, a.files, session);
}

void add_measures(CLI::App* command, std::set<Measure>& measures) {
    command
        ->add_option_function<std::vector<std::string>>(
            "--measure",
            [&measures](const std::vector<std::string>& names) {
                for (const std::string& name : names)
                    measures.insert(chosen("--measure", kMeasures, name));
            },
            "further measurement of the files; repeat the option for several\n"
            "default: only the errors of the second file, which is then required" +
                explained(kMeasures))
        ->allow_extra_args(false) // one each time, so that the files may follow
        ->type_name(names_of(kMeasures));
}

} // namespace

void add_evaluate(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("evaluate", "Measure the error of a compressed file against its bake");
    auto& a = arguments_for<EvaluateArguments>(command, [command, &session](const EvaluateArguments& given) {
        check_light_options(*command, !given.lights.empty());
        run(given, session);
    });
    command
        ->add_option("baked", a.baked,
                     "reference for the second file, and model that --measure measures\n"
                     "                              output of prt bake, or of prt make --keep-bake")
        ->required()
        ->check(named);
    command
        ->add_option(
            "shipped", a.shipped,
            "compressed file made from the first file, or another bake to compare\n"
            "                              other bake: same vertices or texels, SH order (--order) and "
            "lamps\n"
            "                              lamps: same names; --lamps all and indirect can be compared\n"
            "                              not needed with --measure")
        ->check(named);
    CLI::Option* lights =
        add_lights(
            command, a.lights,
            "light under which errors are measured\n"
            "default: built-in lights: a uniform sky, an overcast sky and a sun; FILE replaces all three\n"
            "with a second file also: these lights together with all lamps of the bake;\n"
            "  the worst of 64 suns, random light, all lamps, each lamp alone\n"
            "light file: at least the order of the first file")
            ->default_str("three built-in lights");
    add_light_options(command, a.light_options);
    add_suns(
        command, a.suns,
        std::string("number of suns of --lights for which a renderer has shadow maps\n"
                    "needs --lights; separate suns: without their direct light, which a renderer adds\n"
                    "errors of shipped: with these suns in the sky, and with these suns separate\n"
                    "  only in the sky: after prt compress --combine-direct, with lamps, and coarser levels\n"
                    "  only separate: errors of clusters and of shared instances\n"
                    "--measure sweep: only in the sky; budget and volume: only separate\n"
                    "  budget after prt compress --combine-direct: only in the sky\n") +
            kSunsOfLightFiles,
        "auto");
    command
        ->add_option("--rotations", a.rotations,
                     "number of rotations about +Y of each file of --lights\n"
                     "equally spaced over 360 degrees, the first at --rotate; 1 to 64; 1: only the first\n"
                     "needs --lights; only 1 with --measure budget and with --measure volume")
        ->capture_default_str()
        ->check(CLI::Range(1, 64))
        ->needs(lights);
    command->get_option("--suns")->needs(lights);
    add_measures(command, a.measures);
    add_no_shadow(command, a.no_shadow,
                  "\nrepeat the --no-shadow options of prt bake, because the bake does not contain them\n"
                  "no effect without --measure budget or volume");
    add_reading(command, a.reading);
    add_threads(command, a.threads);
    add_reports(command, a.files);
}

} // namespace prt::cli
