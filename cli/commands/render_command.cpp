// prt render: draws a model under a light.

#include "cli/commands/commands.h"

#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/view_arguments.h"
#include "cli/pipeline/render_model.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/image/image_file.h"

namespace prt::cli {
namespace {

struct RenderArguments : RenderRequest {
    Path json;
};

constexpr Choice<Show> kShows[] = {
    {"lit", Show::lit, "the model in the light of sky and lamps"},
    {"clusters", Show::clusters,
     "a color for each cluster; needs a compressed model without shared instances"},
    {"error", Show::error,
     "error against a reference: needs either --baked or --path-trace\n"
     "  --baked: contrast error, white: 10 %; --path-trace: HDR-FLIP, white: 1"},
    {"ao", Show::ao,
     "ambient occlusion: the model under a uniform white sky instead of --lights\n"
     "  without lamps, colors and textures of materials; a model without transfer is white\n"
     "  by the transfer of the model, which contains the bounces of the bake"}};
constexpr Choice<ToneMap> kToneMaps[] = {
    {"filmic", ToneMap::filmic, "a film curve, which compresses dark and bright values softly"},
    {"srgb", ToneMap::srgb, "the sRGB curve; values above 1 are clipped"}};
constexpr Choice<Backend> kDevices[] = {
    {"auto", Backend::automatic,
     "a hardware GPU with OpenGL 4.5 if there is one, else the CPU\n"
     "  the CPU also if --suns separates more than 4 suns"},
    {"cpu", Backend::cpu, "the CPU, by casting rays"},
    {"gpu", Backend::gpu,
     "OpenGL 4.5 on a GPU, or on a software driver; more than 4 suns of --suns are an error"}};

constexpr const char* kScaledGroups =
    ", except in a lamp that also contains lights:\n"
    "  a group of prt bake, or a material with the name of a light\n"
    "prt bake --lamp-scale changed the baked light already: the factors multiply\n"
    "model without transfer: only with --path-trace; else its lamps light nothing";

/// Checks options that depend on each other, which CLI11 cannot check.
void check_together(const RenderArguments& a) {
    const bool error = a.look.show == Show::error;
    if ((error && a.baked.empty() == !a.traced()) || (!error && !a.baked.empty()))
        throw CLI::ValidationError("--show error", "needs either --baked FILE or --path-trace N");
    if (a.traced() && !error && a.look.show != Show::lit)
        throw CLI::ValidationError("--path-trace", "needs --show lit or --show error");
}

/// Rejects settings of the exposed picture for outputs that are not exposed.
void check_exposed(const RenderArguments& a, const CLI::App& command) {
    for (const char* name : {"--tone-map", "--exposure"}) {
        if (command.count(name) == 0)
            continue;
        if (suffix_of(a.output) == ".exr")
            throw CLI::ValidationError(name, "needs a .png output: an .exr file contains linear radiance");
        if (a.look.show != Show::lit)
            throw CLI::ValidationError(name, "needs --show lit: other pictures have a fixed scale");
    }
}

void run(RenderArguments a, Session& session) {
    check_together(a);
    a.reading.outputs =
        check_outputs({{a.output, "--output", {".png", ".exr"}, true}, {a.json, "--json", {".json"}}},
                      {a.model.path, a.environment, a.lights.lamps.file, a.baked.path});
    a.reading.notify = print_notices;
    const RenderedPicture picture = render_model(a, session.host());
    session.write(a.output, picture.display.empty()
                                ? encode_exr(picture.linear)
                                : encode_png(a.view.width, a.view.height, picture.display));
    publish(picture.report, a.json, session);
}

/// Adds options of what is drawn, and by which processor.
void add_shown(CLI::App* command, RenderArguments& a) {
    choice(command, "--device", a.backend, kDevices,
           "processor that draws the picture\n"
           "path tracing always runs on the CPU",
           "auto");
    choice(command, "--show", a.look.show, kShows, "quantity that the picture shows", "lit");
    command
        ->add_option("--baked", a.baked.path,
                     "bake of the model: the reference of --show error\n"
                     "output of prt bake from which the model was made; not a compressed file\n"
                     "--show error needs either this option or --path-trace; only with --show error")
        ->type_name("FILE")
        ->check(named);
    command
        ->add_option(
            "--path-trace", a.look.paths,
            "path trace the scene with N paths per pixel; ignores transfer\n"
            "N: 2 to 1048576, an odd N is rounded up; default: the model is lit by its transfer\n"
            "traces all bounces; lamps: those of the bake; model without transfer: all lamps\n"
            "materials with subsurface scattering are opaque\n"
            "only with --show lit, or with --show error without --baked: as the reference of the error\n"
            "--suns, --window and --samples have no effect on the path-traced light\n"
            "--exposure auto is measured from the transfer if the model has transfer")
        ->type_name("N")
        ->check(CLI::Range(2, 1 << 20));
}

/// Adds options of exposure, sampling and background.
void add_look(CLI::App* command, RenderArguments& a) {
    add_exposure(command, a.look.exposure);
    choice(command, "--tone-map", a.look.tone_map, kToneMaps,
           "tone curve of the picture; needs a .png file and --show lit", "filmic");
    command
        ->add_option("--samples", a.view.samples,
                     "samples along each axis of a pixel, 1 to 16: N x N per pixel\n"
                     "no effect on a path-traced picture\n"
                     "N times --size above the limit of a GPU is an error; the CPU has no limit")
        ->capture_default_str()
        ->check(CLI::Range(1, 16));
    command->add_flag(
        "!--no-background", a.look.background,
        "draw a black background; default: the image of --lights\n"
        "always black without --lights, with a light file, and with --show clusters, error and ao");
}

} // namespace

void add_render(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("render", "Draw a picture of a file under a light");
    auto& a = arguments_for<RenderArguments>(command, [command, &session](const RenderArguments& given) {
        check_light_options(*command, !given.environment.empty());
        check_exposed(given, *command);
        run(given, session);
    });
    command
        ->add_option(
            "model", a.model.path,
            "model to draw: a scene, or output of prt bake, compress, make or lobes\n"
            "                              .gltf, .glb, .obj or .ply; skinned meshes have the pose of the "
            "file\n"
            "                              a scene without transfer: sky without shadows, suns with\n"
            "                              shadows, no lamps; with --path-trace: all light")
        ->required()
        ->check(named);
    add_light(command, a.environment);
    add_output(command, a.output,
               "write the picture to this file, .png or .exr\n"
               ".png: 8 bits; --show lit: with --exposure and --tone-map; others: not exposed, sRGB curve\n"
               ".exr: float32, linear values without exposure and tone curve");
    add_view(command, a.view);
    add_shown(command, a);
    add_look(command, a);
    add_light_options(command, a.light_options);
    add_suns(command, a.lights.suns,
             std::string("number of suns of --lights that are drawn with sharp shadows\n"
                         "needs --lights; no effect on --show clusters and ao, and on path-traced pictures\n"
                         "more than 4 suns: drawn by the CPU; with --device gpu an error\n"
                         "--show error --baked: the direct light of these suns is not part of the error\n"
                         "after prt compress --combine-direct or prt lobes: only 0, and auto acts as 0\n") +
                 kSunsOfLightFiles,
             "auto", &a.lights.sun_rays);
    command->get_option("--suns")->needs("--lights");
    add_lamps(command, a.lights.lamps);
    add_lamp_scale(command, a.lights.lamp_scale, kScaledGroups);
    add_reading(command, a.reading);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

} // namespace prt::cli
