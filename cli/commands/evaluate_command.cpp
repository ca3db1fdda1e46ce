// prt evaluate: measures errors of a compressed file or of a bake.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/pipeline/evaluate_model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"

#include <set>

namespace prt::cli {
namespace {

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

struct EvaluateArguments : EvaluateRequest {
    ReportFiles files;
};

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
    inputs.insert(inputs.end(), {a.baked.path, a.shipped.path});
    return check_outputs({{a.files.json, "--json", {".json"}},
                          {a.files.html, "--report", {".html", ".htm"}},
                          {a.files.csv, "--report", {".csv"}}},
                         inputs);
}

void run(EvaluateArguments a, Session& session) {
    a.reading.outputs = check(a);
    a.pictures = !a.files.html.empty();
    Report report = evaluate_model(a, session.host());
    report.title = a.shipped.empty() ? "Rate and distortion of " + a.baked.path.filename().string()
                                     : a.shipped.path.filename().string() + " against its bake";
    report.origin = {{"baked", a.baked.string()}};
    if (!a.shipped.empty())
        report.origin.emplace_back("shipped", a.shipped.string());
    report.origin.emplace_back("command", session.command_line());
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
        ->add_option("baked", a.baked.path,
                     "reference for the second file, and model that --measure measures\n"
                     "                              output of prt bake, or of prt make --keep-bake")
        ->required()
        ->check(named);
    command
        ->add_option(
            "shipped", a.shipped.path,
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
            "with a second file also: each of these lights with all lamps of the bake;\n"
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
