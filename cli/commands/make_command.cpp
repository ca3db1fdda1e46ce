// prt make: bakes and compresses a scene in one step.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/make_model.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/shell_word.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"

namespace prt::cli {
namespace {

constexpr const char* kMaxErrorText =
    "find the fewest bytes per vertex with at most this error\n"
    "X: above 0; relative L2 over the surface against path tracing\n"
    "  root mean square over --lights\n"
    "  lamps of the scene are off, and each light has only the rotation of --rotate\n"
    "an error if no result has at most X, or if the error before compression is above 0.92 X\n"
    "  --best-effort: then writes the closest result, which can still meet X\n"
    "default: 0.03 (3 %), or 1.2 times the error before compression if that is larger\n"
    "  if it is not met, the closest result is written\n"
    "not with --bytes-per-vertex, which has no limit of the error";

struct MakeArguments {
    MakeRequest request;
    ReportFiles files;
};

void run(MakeArguments a, Session& session) {
    MakeRequest& r = a.request;
    std::vector<Path> inputs = r.lights;
    inputs.push_back(r.scene);
    r.reading.outputs = check_outputs({{r.output, "--output", {".glb"}},
                                       {r.baked, "--keep-bake", {".glb"}},
                                       {a.files.json, "--json", {".json"}},
                                       {a.files.html, "--report", {".html", ".htm"}},
                                       {a.files.csv, "--report", {".csv"}}},
                                      inputs);
    Report report;
    report.title = "Made of " + r.scene.filename().string();
    report.origin = {{"scene", r.scene.string()}, {"command", session.command_line()}};
    make_model(r, report, session.host());
    publish(report, a.files, session);
}

/// Adds options of the goal.
void add_goals(CLI::App* command, MakeGoal& goal) {
    CLI::Option* error = command->add_option("--max-error", goal.max_error, kMaxErrorText)
                             ->check(above_zero())
                             ->default_str("0.03");
    command
        ->add_option("--bytes-per-vertex", goal.bytes_per_vertex,
                     "find the minimum error with at most X bytes per vertex, with bases\n"
                     "X: the bytes of its 32-bit words, plus the bytes of all bases / number of vertices\n"
                     "  vertices: those of the written model, to which prt make can add some\n"
                     "if no result has at most X bytes, an error\n"
                     "order, bounces, rays and added vertices are chosen as for --max-error 0.01\n"
                     "replaces the goal --max-error; not with --max-error and --best-effort")
        ->check(above_zero())
        ->excludes(error);
    command
        ->add_option(
            "--seconds", goal.seconds,
            "limit the time to about X seconds by fewer rays and trials\n"
            "triangles are split only if time allows; noise increases, and a given --max-error may fail\n"
            "at least 64 rays per vertex and one compression: large scenes can take longer\n"
            "X: above 0; default: no limit")
        ->check(above_zero());
    command
        ->add_flag("--best-effort", goal.best_effort,
                   "write the closest result if --max-error is not met; default: error\n"
                   "needs --max-error; not with --bytes-per-vertex\n"
                   "without --max-error and --bytes-per-vertex, the closest result is always written")
        ->needs(error);
}

} // namespace

void add_make(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("make", "Bake and compress a scene with the fewest bytes for an error");
    auto options_of_lights = std::make_shared<std::vector<const CLI::Option*>>();
    auto& a = arguments_for<MakeArguments>(command, [&session, options_of_lights](MakeArguments given) {
        for (const CLI::Option* option : *options_of_lights)
            for (const std::string& value : option->results())
                given.request.light_options += " " + option->get_name() + " " + shell_word(value);
        run(std::move(given), session);
    });
    MakeRequest& r = a.request;
    command
        ->add_option("scene", r.scene,
                     "scene to bake and compress: glTF 2.0 (.gltf, .glb), .obj or .ply\n"
                     "                              a material with subsurface scattering is an error")
        ->required()
        ->check(named);
    add_output(command, r.output, "write the compressed model to this file, .glb");
    add_lights(command, r.lights,
               "light in which the model will be used\n"
               "up to 4 suns of an image and all suns of a light file are separate: renderers add their\n"
               "  direct light with shadow maps; --max-error includes only their light after bounces\n"
               "light file: at least of order 6 and of the order that is chosen; 10 is always enough")
        ->required();
    add_goals(command, r.goal);
    command
        ->add_option("--keep-bake", r.baked,
                     "also write the bake before compression to this file; default: no file\n"
                     "the file is like one of prt bake: for prt compress, prt evaluate, prt render --baked")
        ->check(named)
        ->type_name("FILE.glb");
    add_lamp_scale(command, r.reading.lamp_scale,
                   "\nthe written file contains the scaled lights; do not scale them again");
    add_no_shadow(command, r.no_shadow);
    add_back_sides(command, r.back_sides);
    const std::size_t before = command->get_options().size();
    add_light_options(command, r.reading_lights);
    const auto all = command->get_options();
    options_of_lights->assign(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
    add_reading(command, r.reading);
    add_smooth_normals(command, r.reading);
    add_threads(command, r.threads);
    add_reports(command, a.files);
}

} // namespace prt::cli
