// prt lobes: bakes lobes for skinned meshes.

#include "cli/commands/commands.h"

#include "bake/gltf/encode_glb.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/arguments/suboptions.h"
#include "cli/arguments/texel_arguments.h"
#include "cli/arguments/trace_arguments.h"
#include "cli/pipeline/back_sides.h"
#include "cli/pipeline/level_report.h"
#include "cli/pipeline/lobe_errors.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/compress/light_metric.h"
#include "prt/core/error.h"
#include "prt/fit/lobe_fit.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace prt::cli {
namespace {

struct LobesArguments {
    Path model, output, json;
    std::string animation;
    int poses = 8, frames = 6;
    PoseBakeOptions bake;
    LobeFitOptions fit;
    BackSides back_sides = BackSides::automatic;
    HighPolyRequest high_poly;
    ReadingOptions reading;
};

/// The model, its poses, and its scene with VertexArray::lobes of vertices that move.
struct Figure {
    AnimatedScene model;
    std::vector<ModelPose> poses;
    Scene scene;
};

/// Throws `Error` if a skinned mesh has no weights: the skin could not rotate its transfer.
void check_weights(const AnimatedScene& model) {
    for (const Primitive& primitive : model.scene().primitives) {
        const MovingVertices& moving = model.vertices()[primitive.vertices];
        if (moving.skin < 0)
            continue;
        const std::size_t identity = model.skins()[static_cast<std::size_t>(moving.skin)].joints.size();
        const bool weighted =
            std::ranges::any_of(moving.matrices, [&](std::uint32_t matrix) { return matrix != identity; });
        if (!weighted)
            throw Error(fmt::format("mesh {} primitive {} has a skin, but no weights: JOINTS_0 and WEIGHTS_0",
                                    primitive.mesh, primitive.primitive));
    }
}

/// Whether some vertex of `scene` with lobes lies elsewhere in some pose than in the first.
bool moves(const AnimatedScene& model, const Scene& scene, std::span<const ModelPose> poses) {
    const auto points = [&](const ModelPose& pose) {
        std::vector<std::vector<glm::vec3>> arrays;
        Scene posed = model.posed(pose.nodes, glm::dmat4(1));
        for (std::size_t array = 0; array < posed.vertex_arrays.size(); ++array)
            if (scene.vertex_arrays[array].lobes)
                arrays.push_back(std::move(posed.vertex_arrays[array].positions));
        return arrays;
    };
    const auto first = points(poses.front());
    return std::ranges::any_of(poses.subspan(1),
                               [&](const ModelPose& pose) { return points(pose) != first; });
}

/// Returns the scene with VertexArray::lobes of vertices that move. Throws `Error` if none can move.
Scene with_figure(const AnimatedScene& model, std::span<const ModelPose> poses) {
    Scene scene = model.scene();
    const std::vector<bool> moving = moving_arrays(model, poses);
    for (std::size_t array = 0; array < moving.size(); ++array)
        scene.vertex_arrays[array].lobes = moving[array];
    if (std::ranges::find(moving, true) == moving.end())
        throw Error("no vertex moves in these poses; use prt bake for a model that does not move");
    return scene;
}

/// Reads the figure. Throws `Error` if none of its vertices can move.
Figure figure_in(const GltfDocument& document, const LobesArguments& a) {
    AnimatedScene model(document, a.bake.levels == LevelMode::ignore ? ReadLevels::finest : ReadLevels::all);
    check_weights(model);
    std::vector<ModelPose> poses = poses_of(model, a.poses, a.animation);
    Scene scene = with_figure(model, poses);
    return {std::move(model), std::move(poses), std::move(scene)};
}

/// Returns the receivers of the vertices that get lobes.
std::vector<std::size_t> receivers_of(const Figure& figure) {
    std::vector<std::size_t> receivers;
    for (const VertexArray& vertices : figure.scene.vertex_arrays)
        for (std::size_t v = 0; vertices.lobes && v < vertices.size(); ++v)
            receivers.push_back(vertices.first_receiver + v);
    return receivers;
}

/// Returns the receivers of level 0 that get lobes.
std::vector<std::size_t> finest_receivers_of(const Figure& figure) {
    std::vector<std::size_t> receivers = receivers_of(figure);
    std::erase_if(receivers, [&](std::size_t r) { return r >= figure.model.leveled().finest_receivers; });
    return receivers;
}

/// Returns the mean square of lighting in each band, over all orientations.
void set_band_costs(int order, LobeFitOptions& options) {
    const LightMetric metric = natural_metric(layout_of_one(order, 1));
    const auto size = static_cast<std::size_t>(coefficient_count(order));
    options.band_costs.fill(0);
    for (int l = 0; l < order; ++l) {
        const auto i = static_cast<std::size_t>(sh_index(l, 0));
        options.band_costs[static_cast<std::size_t>(l)] = metric.moments[i * size + i];
    }
}

struct Made {
    LobeModel lobes; ///< words of 0 for vertices that do not move
    MeanTransfer mean;
    std::size_t figure = 0; ///< number of vertices with lobes
    double bake_seconds = 0, fit_seconds = 0;
    double fit_error = 0, coded_error = 0; ///< against the mean, before and after bytes
};

Made make_lobes(const LobesArguments& a, const Figure& figure, Session& session) {
    Made made;
    const std::vector<std::size_t> receivers = receivers_of(figure);
    made.figure = receivers.size();
    const Stopwatch baking;
    {
        ProgressBar bar = session.progress_bar("baking poses");
        made.mean = mean_of_poses(figure.model, figure.poses, a.bake, bar.progress());
    }
    made.bake_seconds = baking.seconds();
    const Stopwatch fitting;
    ProgressBar bar = session.progress_bar("fitting lobes");
    const std::size_t coefficients = made.mean.coefficients();
    std::vector<double> vectors;
    std::vector<float> areas;
    for (const std::size_t receiver : receivers) {
        const auto first = made.mean.vectors.begin() + static_cast<std::ptrdiff_t>(receiver * coefficients);
        vectors.insert(vectors.end(), first, first + static_cast<std::ptrdiff_t>(coefficients));
        areas.push_back(made.mean.areas[receiver]);
    }
    const LobeTargets targets{a.bake.order, vectors, areas};
    const std::vector<Lobe> fitted = fit_lobes(targets, a.fit, bar.progress().range(0, 0.5));
    made.lobes = code_lobes(targets, fitted, a.fit, bar.progress().range(0.5, 1));
    made.fit_seconds = fitting.seconds();
    made.fit_error = lobe_error(targets, fitted, a.fit);
    made.coded_error = lobe_error(targets, decoded(made.lobes), a.fit);
    const std::vector<LobeWord> words = std::exchange(made.lobes.words, {});
    made.lobes.words.resize(figure.scene.receivers() * made.lobes.lobes);
    for (std::size_t i = 0; i < words.size(); ++i)
        made.lobes.words[receivers[i / made.lobes.lobes] * made.lobes.lobes + i % made.lobes.lobes] =
            words[i];
    return made;
}

Report report_of(const LobesArguments& a, const Made& made, std::size_t poses) {
    const LobeModel& lobes = made.lobes;
    Report report;
    add_figures(report, {{"vertices", made.figure},
                         {"vertices_hidden", made.mean.hidden},
                         {"order", lobes.order},
                         {"lobes_per_vertex", lobes.lobes},
                         {"bytes_bound_per_vertex", lobes.lobes * sizeof(LobeWord)},
                         {"profiles", lobes.profiles.size()},
                         {"bytes_profiles",
                          lobes.profiles.size() * sizeof(float) * static_cast<std::size_t>(lobes.order)},
                         {"poses", poses},
                         {"rays", made.mean.rays},
                         {"rays_per_receiver", made.mean.rays_per_vertex},
                         {"bounces", a.bake.bounces},
                         {"fit_relative_l2", made.fit_error},
                         {"coded_relative_l2", made.coded_error},
                         {"bake_seconds", made.bake_seconds},
                         {"fit_seconds", made.fit_seconds}});
    report.sentences = {
        "{output}: {lobes_per_vertex:#lobe} for each of {vertices} vertices, {bytes_bound_per_vertex} bytes "
        "per vertex, {profiles} profiles of {bytes_profiles} bytes",
        "fitted to {poses} poses: {fit_relative_l2:.2f%} off their mean, {coded_relative_l2:.2f%} in bytes",
        "poses baked in {bake_seconds:.2f} s, lobes fitted in {fit_seconds:.2f} s"};
    if (made.mean.hidden > 0)
        report.sentences.emplace_back(
            "{vertices_hidden} vertices are inside geometry in all poses and have the "
            "light of their neighbours");
    return report;
}

/// Measures the error of level 0.
void measure_frames(const LobesArguments& a, const Figure& figure, const Made& made, Session& session,
                    Report& report) {
    if (a.frames == 0)
        return;
    ProgressBar bar = session.progress_bar("measuring");
    PoseBakeOptions options = a.bake;
    options.seed += 0x51ed270b; // far from the seeds of the poses, which are consecutive
    add_lobe_errors({.model = figure.model,
                     .figure = finest_receivers_of(figure),
                     .lobes = made.lobes,
                     .mean = made.mean,
                     .frames = frames_of(figure.model, a.frames, a.animation),
                     .options = options},
                    bar.progress(), report);
}

/// Prints a notice about vertices that have neither lobes nor transfer.
void note_the_rest(const LobesArguments& a, const Scene& scene, const Made& made, bool has_transfer) {
    if (!has_transfer && made.figure < scene.receivers())
        print_notices(a.model.string(),
                      {prt::counted(scene.receivers() - made.figure, "vertex does", "vertices do") +
                       " not move and have no transfer; prt bake bakes it, before or after prt lobes"});
}

/// Throws `Error` if vertices have lobes in the file, but not in `scene`: they would have no transfer.
void check_former_figure(const Scene& file, const Scene& scene) {
    std::size_t lost = 0;
    for (std::size_t array = 0; array < file.vertex_arrays.size(); ++array)
        lost += file.vertex_arrays[array].lobes && !scene.vertex_arrays[array].lobes
                    ? file.vertex_arrays[array].size()
                    : 0;
    if (lost > 0)
        throw Error(prt::counted(lost, "vertex has lobes in the file, but does",
                                 "vertices have lobes in the file, but do") +
                    " not move in these poses; bake transfer first with prt bake --stored-lobes remove");
}

/// Reads the model of --high-poly; empty without one.
std::optional<AnimatedScene> load_high_poly(const LobesArguments& a) {
    if (a.high_poly.file.empty())
        return std::nullopt;
    std::optional<AnimatedScene> model(load_gltf(a.high_poly.file, a.reading));
    print_notices(a.high_poly.file.string(), model->scene().notices);
    return model;
}

/// Gives the sides of double-sided surfaces of the figure separate vertices. Returns whether `document`
/// changed.
bool separate_backs(const LobesArguments& a, const Figure& figure, GltfDocument& document) {
    return separate_sides_of_figure({.sides = a.back_sides,
                                     .path = a.model,
                                     .options = bake_options_of(a.bake),
                                     .no_shadow = {},
                                     .levels = a.bake.levels != LevelMode::ignore,
                                     .notify = print_notices},
                                    figure.model, figure.scene, figure.poses, document);
}

/// Adds the coarser levels of the figure to the report.
void add_levels_of(const LobesArguments& a, const Figure& figure, const Made& made, Report& report) {
    if (made.mean.levels.levels.empty())
        return;
    BakedLevels levels;
    levels.scene.nodes = moving_levels(figure.model, figure.poses);
    levels.mode = a.bake.levels;
    levels.bake = made.mean.levels;
    add_level_bake(levels, report);
}

/// Bakes and fits lobes, and writes them into the document of `input`.
Report bake_lobes(const LobesArguments& a, ModelToPassOn& input, Session& session) {
    GltfDocument& document = input.document;
    Figure figure = figure_in(document, a);
    print_notices(a.model.string(), figure.model.leveled().notices);
    if (!moves(figure.model, figure.scene, figure.poses))
        print_notices(a.model.string(),
                      {"no vertex moves in these poses; use prt bake for a model that does not move"});
    if (input.has_transfer)
        check_former_figure(figure.model.scene(), figure.scene);
    if (separate_backs(a, figure, document))
        figure = figure_in(document, a);
    const Made made = make_lobes(a, figure, session);
    Report report = report_of(a, made, figure.poses.size());
    add_levels_of(a, figure, made, report);
    if (a.bake.high_poly) // its surface can be missing near vertices
        print_notices(a.high_poly.file.string(), made.mean.notices);
    note_the_rest(a, figure.scene, made, input.has_transfer);
    measure_frames(a, figure, made, session, report);
    if (finest_receivers_of(figure).size() == figure.model.leveled().finest_receivers)
        discard_transfer(document); // levels that do not move may have some, but readers need level 0
    write_lobes(document, figure.scene,
                {made.lobes,
                 {.poses = static_cast<int>(figure.poses.size()),
                  .rays = made.mean.rays_per_vertex,
                  .bounces = a.bake.bounces,
                  .seed = a.bake.seed}});
    return report;
}

void run(LobesArguments a, Session& session) {
    check_device(a.bake.tracer);
    check_method(a.bake.tracer);
    a.reading.outputs = check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}},
                                      {a.model, a.high_poly.file});
    check_high_poly(a.high_poly);
    a.bake.bad_textures = a.reading.bad_textures;
    a.fit.threads = a.bake.threads;
    set_band_costs(a.bake.order, a.fit);
    ModelToPassOn input = load_to_pass_on(a.model, a.reading);
    const std::optional<AnimatedScene> high_poly = load_high_poly(a);
    a.bake.high_poly = high_poly ? &*high_poly : nullptr;
    a.bake.reach = a.high_poly.distance_in(input.scene);
    input.scene = {}; // frees memory: the figure has it
    Report report = about(a.model, [&] { return bake_lobes(a, input, session); });
    const std::vector<std::byte> file = about(a.model, [&] { return encode_glb(input.document); });
    add_figures(report, {{"output", a.output.string()}, {"bytes_file", session.write(a.output, file)}});
    publish(report, a.json, session);
}

void add_quality(CLI::App* command, LobesArguments& a) {
    command->add_option("--lobes", a.fit.lobes, "number of lobes per vertex, 1 to 3; a lobe has four bytes")
        ->capture_default_str()
        ->check(CLI::Range(std::size_t{1}, kMaxLobes));
    command->add_option("--order", a.bake.order, "SH order N of the lobes, 2 to 4: N bands, l = 0 to N - 1")
        ->capture_default_str()
        ->check(CLI::Range(2, kMaxLobeOrder));
    Suboptions("--poses", "N",
               "number of animation poses, in addition to the pose of the file\n"
               "N: 1 to 4096 in total, at equal intervals in the time of all animations\n"
               "lobes are fitted to the mean transfer of all poses; a model without animation is an error",
               [&a](const std::string& text) {
                   const std::optional<int> poses = whole_number(text);
                   if (!poses || *poses < 1 || *poses > 4096)
                       throw CLI::ValidationError("--poses", "'" + text + "' is not a number in 1..4096");
                   a.poses = *poses;
               })
        .whole_number("frames", 0, 4096,
                      "number of frames in total at which the error is measured [6]\n"
                      "  0 to 4096; 0: no measurement",
                      [&a](int frames) { a.frames = frames; })
        .key("animation", "NAME", "take poses and frames from this animation only [all animations]",
             [&a](const std::string& name) { a.animation = name; })
        .add(command)
        ->default_str("8");
    CLI::Option* rays = command
                            ->add_option("--rays", a.bake.rays,
                                         "number of rays per vertex and pose, 1 to 2^24\n"
                                         "also for each frame at which the error is measured\n"
                                         "with --method raster: number of directions of depth maps")
                            ->capture_default_str()
                            ->check(CLI::Range(1, kMaxRays));
    add_target_error(command, rays, a.bake.target_error,
                     "\nin each pose and frame; the number of rays differs between vertices\n"
                     "  it is the same for all with --method raster");
    add_method(command, a.bake.tracer, "bounces");
    command
        ->add_option("--bounces", a.bake.bounces,
                     "number of bounces between surfaces of the model\n"
                     "0 to 10000; 0: direct light only")
        ->capture_default_str()
        ->check(CLI::Range(0, kMaxBounces));
}

} // namespace

void add_lobes(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("lobes", "Bake zonal lobes for skinned meshes, which rotate with the skin");
    auto& a = arguments_for<LobesArguments>(command,
                                            [&session](const LobesArguments& given) { run(given, session); });
    command
        ->add_option("model", a.model,
                     "model to bake: glTF 2.0 with at least one animation, .gltf or .glb\n"
                     "                              meshes with a skin need JOINTS_0 and WEIGHTS_0\n"
                     "                              vertices that do not move keep their transfer")
        ->required()
        ->check(named);
    add_output(command, a.output, "write the model with its lobes to this file, .glb");
    add_quality(command, a);
    add_back_sides(command, a.back_sides,
                   "\nfor vertices that move; light of the sky in any of the poses, not of lamps");
    add_high_poly(
        command, a.high_poly,
        "\nFILE has the skeleton of the model: its nodes move as those of the model with the same names\n"
        "bounces are those of FILE; an error if a joint of FILE has no such name");
    add_levels(command, a.bake.levels,
               "\nlevels that move get lobes, in each pose as requested; others keep their transfer");
    add_device(command, a.bake.tracer);
    add_seed(command, a.bake.seed);
    add_reading(command, a.reading);
    add_threads(command, a.bake.threads);
    add_json(command, a.json);
}

} // namespace prt::cli
