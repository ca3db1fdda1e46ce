// prt ao: bakes ambient occlusion into vertices or textures.

#include "cli/commands/commands.h"

#include "bake/gltf/encode_glb.h"
#include "cli/arguments/options.h"
#include "cli/arguments/scene_arguments.h"
#include "cli/arguments/texel_arguments.h"
#include "cli/pipeline/back_sides.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/occluders.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt::cli {
namespace {

struct AoArguments {
    Path scene, output, json;
    std::vector<std::string> no_shadow; ///< names of materials
    BackSides back_sides = BackSides::automatic;
    std::string attribute = "COLOR_0";
    TexelRequest textures;
    const CLI::Option* texels_option = nullptr;
    OcclusionOptions options;
    std::optional<int> rays;
    struct Outputs {
        bool bent_normals = false, occluders = false;
    } outputs;
    ReadingOptions reading;

    bool in_textures() const { return textures.given(); }
};

constexpr const char* kBentNormal = "_BENT_NORMAL"; ///< attribute

OccluderRequest occluder_request(const AoArguments& a) {
    OccluderOptions options;
    options.rays = a.rays.value_or(options.rays);
    options.tracer = a.options.tracer;
    options.repairs = a.options.repairs;
    options.threads = a.options.threads;
    options.seed = a.options.seed;
    return {options, a.textures.high_poly.file, a.reading, print_notices};
}

/// DISTANCE[:SHARE]
Falloff::Term parse_term(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::optional<double> distance = real_number(text.substr(0, colon)),
                                share =
                                    colon == std::string::npos ? 1.0 : real_number(text.substr(colon + 1));
    if (!distance || !share || !(*distance > 0) || !(*share >= 0) || !std::isfinite(*distance) ||
        !std::isfinite(*share))
        throw CLI::ValidationError("--falloff", "'" + text + "' is not DISTANCE[:SHARE], as 2:97");
    return {*distance, *share};
}

std::vector<std::byte> grey_png(const Atlas& atlas, std::span<const float> values) {
    std::vector<glm::u8vec3> pixels;
    for (const float v : values)
        pixels.emplace_back(static_cast<std::uint8_t>(std::lround(255 * v)));
    return encode_png(atlas.width, atlas.height, pixels);
}

std::vector<std::byte> normal_png(const Atlas& atlas, std::span<const glm::vec3> normals) {
    std::vector<glm::u8vec3> pixels;
    for (const glm::vec3& n : normals)
        pixels.emplace_back(glm::vec3(0.5f) + 127.5f * (n + 1.0f));
    return encode_png(atlas.width, atlas.height, pixels);
}

/// Returns the area-weighted mean of the vertices.
double mean_of(std::span<const float> values, std::span<const float> weights) {
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        sum += static_cast<double>(weights[i]) * static_cast<double>(values[i]);
        all += static_cast<double>(weights[i]);
    }
    return all > 0 ? sum / all : 0;
}

void add_notices(Report& report, const std::vector<std::string>& notices) {
    Json all = Json::array();
    for (const std::string& notice : notices) {
        report.sentences.push_back(fmt::format("{{notices/{}}}", all.size()));
        all.push_back(notice);
    }
    add_figures(report, {{"notices", all}});
}

/// Closed rooms are black, because every surface blocks at any distance.
constexpr float kBlack = 0.01f;
constexpr double kNoticedBlackShare = 0.5;
std::vector<std::string> notices_of_black(const AoArguments& a, double share) {
    if (share < kNoticedBlackShare || !a.options.tracer.falloff.blocks_everywhere())
        return {};
    return {fmt::format(
        "{:.0f} % of the surface is black, as in a closed room; use --falloff 1: distant surfaces then "
        "block less",
        100 * share)};
}

/// Returns the fraction of the area of vertices whose ambient light is black.
double black_share(std::span<const float> ambient, std::span<const float> areas) {
    std::vector<float> black;
    for (const float v : ambient)
        black.push_back(v < kBlack ? 1.0f : 0.0f);
    return mean_of(black, areas);
}

Report bake_vertices(const AoArguments& a, GltfDocument& document, const Scene& scene,
                     const Progress& progress) {
    const HighPoly finer = load_high_poly(a.textures, a.reading, scene, print_notices);
    const OcclusionResult result = ambient_occlusion(scene, a.options, progress, finer.model());
    const BakeStatistics& s = result.statistics;
    std::vector<VertexAttribute> attributes;
    if (a.attribute == "COLOR_0")
        attributes.push_back(shaded_vertex_colors(scene, result.ambient_visibility.ambient));
    else
        attributes.push_back({a.attribute, 1, result.ambient_visibility.ambient});
    if (a.outputs.bent_normals) {
        VertexAttribute& bent = attributes.emplace_back(VertexAttribute{kBentNormal, 3, {}});
        for (const glm::vec3& n : result.ambient_visibility.bent_normals)
            bent.values.insert(bent.values.end(), {n.x, n.y, n.z});
    }
    write_vertex_attributes(document, scene, attributes);
    const std::vector<float> areas = receiver_areas(scene);
    Report report;
    add_figures(report, {{"receivers", s.receivers.all},
                         {"receivers_enclosed", s.receivers.sealed},
                         {"rays", s.rays},
                         {"rays_per_receiver", a.options.rays},
                         {"device", s.device},
                         {"fit", s.fit.samples > 0 ? "surface" : "vertex"},
                         {"sampling_error_relative_l2", s.sampling_error},
                         {"mean_ambient", mean_of(result.ambient_visibility.ambient, areas)}});
    report.sentences = {
        fmt::format("{{output}}: occlusion of {{receivers}} vertices in {}, {{rays_per_receiver}} rays "
                    "each, on {{device}}",
                    a.attribute == "COLOR_0" ? "COLOR_0, multiplied by the existing colors" : a.attribute),
        s.fit.samples > 0 ? "fitted to the surface between vertices" : "measured at vertices"};
    std::vector<std::string> notices =
        notices_of_black(a, black_share(result.ambient_visibility.ambient, areas));
    std::ranges::copy_if(s.notices, std::back_inserter(notices), [](const std::string& notice) {
        return !notice.starts_with("the transfer has one channel"); // occlusion has no color
    });
    add_notices(report, notices);
    return report;
}

Report bake_textures(const AoArguments& a, GltfDocument& document, const Scene& scene,
                     const std::vector<Atlas>& atlases, const Progress& progress) {
    const HighPoly finer = load_high_poly(a.textures, a.reading, scene, print_notices);
    std::vector<SurfaceTexture> textures;
    Json maps = Json::array();
    std::size_t lit = 0, measured = 0, bright = 0;
    const auto take = [&](const OcclusionMap& map) {
        textures.push_back({.primitives = map.atlas.primitives,
                            .texcoord = map.atlas.uv_set,
                            .repeats = map.atlas.repeats,
                            .occlusion = grey_png(map.atlas, map.ambient_visibility.ambient),
                            .bent_normals = a.outputs.bent_normals
                                                ? normal_png(map.atlas, map.ambient_visibility.bent_normals)
                                                : std::vector<std::byte>()});
        maps.push_back({{"width", map.atlas.width},
                        {"height", map.atlas.height},
                        {"primitives", map.atlas.primitives.size()},
                        {"texels_measured", map.measured},
                        {"texels_enclosed", map.sealed},
                        {"seam_before_rms", map.seam_before},
                        {"seam_rms", map.seam}});
        lit += map.measured - map.sealed;
        measured += map.measured;
        bright += static_cast<std::size_t>(
            std::ranges::count_if(map.ambient_visibility.ambient, [](float v) { return v >= kBlack; }));
    };
    OcclusionMapsStatistics result = occlusion_maps(scene, atlases, a.options, take, finer.model(), progress);
    if (const std::size_t replaced = write_surface_textures(document, scene, textures); replaced > 0)
        result.notices.push_back(fmt::format("occlusion textures of {} materials are replaced", replaced));
    const double open = static_cast<double>(std::min(bright, measured)) /
                        static_cast<double>(std::max<std::size_t>(measured, 1));
    for (std::string& notice : notices_of_black(a, 1 - open))
        result.notices.push_back(std::move(notice));
    Report report;
    add_figures(report, {{"textures", maps.size()},
                         {"texels", measured},
                         {"texels_enclosed", measured - lit},
                         {"rays", result.rays},
                         {"rays_per_texel", a.options.rays},
                         {"rays_per_second", static_cast<double>(result.rays) / result.seconds},
                         {"device", result.device},
                         {"maps", maps}});
    report.sentences = {"{output}: occlusion of {texels} texels in {textures:#texture}, up to "
                        "{rays_per_texel} rays per texel, on "
                        "{device}; {rays_per_second:.2fM} million rays/s"};
    for (std::size_t i = 0; i < maps.size(); ++i)
        report.sentences.push_back(fmt::format(
            "texture {0}: {{maps/{0}/width}} x {{maps/{0}/height}}, jumps across seams (root mean square): "
            "{{maps/{0}/seam_before_rms:.3f}} before, {{maps/{0}/seam_rms:.4f}} after filtering",
            i));
    add_notices(report, result.notices);
    return report;
}

void check_arguments(const AoArguments& a) {
    if (a.attribute != "COLOR_0" && !a.attribute.starts_with("_"))
        throw Error("--attribute: glTF requires that names of custom attributes begin with _, as _AO");
    if (a.attribute == kBentNormal && a.outputs.bent_normals)
        throw Error("--attribute: _BENT_NORMAL is the attribute of --bent-normals; choose another name");
    check_texels(a.textures, a.texels_option);
    if (a.outputs.occluders && !a.options.tracer.falloff.blocks_everywhere())
        throw Error(
            "--occluders does not support --falloff and --max-distance: its volumes have their own reach");
}

/// Gives both sides of double-sided surfaces separate vertices.
void separate(const AoArguments& a, GltfDocument& document, Scene& scene) {
    BakeOptions options;
    options.repairs = {.bad_textures = a.options.repairs.bad_textures};
    options.threads = a.options.threads;
    options.seed = a.options.seed;
    separate_sides({.sides = a.back_sides,
                    .path = a.scene,
                    .options = options,
                    .no_shadow = a.no_shadow,
                    .notify = print_notices},
                   document, scene);
}

Report bake_asked(const AoArguments& a, GltfDocument& document, const Scene& scene, const TexelRoom& room,
                  const Progress& progress) {
    if (a.outputs.occluders)
        return bake_occluders(document, scene, occluder_request(a), progress);
    return a.in_textures() ? bake_textures(a, document, scene, room.atlases, progress)
                           : bake_vertices(a, document, scene, progress);
}

void run(AoArguments a, Session& session) {
    check_device(a.options.tracer);
    check_arguments(a);
    a.options.rays = a.rays.value_or(a.options.rays);
    a.reading.outputs = check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}},
                                      {a.scene, a.textures.high_poly.file});
    a.options.repairs.bad_textures = a.reading.bad_textures;
    const Stopwatch watch;
    ModelToPassOn model = load_to_pass_on(a.scene, a.reading);
    GltfDocument& document = model.document;
    Scene& scene = model.scene;
    if (!a.outputs.occluders && (!a.in_textures() || a.textures.unwrap))
        about(a.scene, [&] { separate(a, document, scene); });
    const TexelRoom room =
        a.in_textures()
            ? about(a.scene, [&] { return make_room(a.textures, a.scene, document, scene, print_notices); })
            : TexelRoom{};
    leave_out_shadows(scene, a.no_shadow);
    Report report;
    {
        ProgressBar bar = session.progress_bar("occlusion");
        report = about(a.scene, [&] { return bake_asked(a, document, scene, room, bar.progress()); });
    }
    const std::vector<std::byte> file = about(a.scene, [&] { return encode_glb(document); });
    add_figures(report, room.figures);
    add_figures(report, {{"output", a.output.string()},
                         {"bytes_file", session.write(a.output, file)},
                         {"seconds", watch.seconds()}});
    report.sentences.push_back("{bytes_file} bytes on disk; {seconds:.2f} s");
    publish(report, a.json, session);
}

void add_outputs(CLI::App* command, AoArguments& a) {
    CLI::Option* texels = add_texels(command, a.textures,
                                     "bake textures of this size instead of vertices; default: vertices\n"
                                     "occlusion textures of the materials, which replace existing ones\n"
                                     "not with --fit, --attribute and --occluders");
    a.texels_option = texels;
    command
        ->add_option("--attribute", a.attribute,
                     "vertex attribute to write: COLOR_0 or a name with leading _\n"
                     "value: fraction of the light of a uniform sky that arrives, 0 to 1\n"
                     "COLOR_0: the value as grey, multiplied by existing vertex colors\n"
                     "other names, as _AO: one number per vertex; an existing attribute is replaced\n"
                     "not with --texels and --occluders; _BENT_NORMAL: not with --bent-normals")
        ->default_str("COLOR_0")
        ->excludes(texels);
    command->add_flag("--bent-normals", a.outputs.bent_normals,
                      "also write bent normals: the mean directions that are not blocked\n"
                      "unit vectors n in the coordinate frame of the scene; not with --occluders\n"
                      "where all directions are blocked: the normal of the vertex; in textures, +Y\n"
                      "vertices: the attribute _BENT_NORMAL\n"
                      "--texels: textures of n / 2 + 1/2, extras.prtkit.bentNormalTexture of the materials");
    command
        ->add_flag(
            "--occluders", a.outputs.occluders,
            "write occlusion volumes of all objects of the scene, not vertex values\n"
            "for contact shadows of moving objects: the scene should contain no static ground and walls\n"
            "object: a root node with all nodes below it; animated nodes and bones are separate objects\n"
            "small animated nodes and bones are merged into the nearest object above in the hierarchy\n"
            "  small: the diagonal of the bounding box is below 12 % of that of the scene\n"
            "--high-poly: nodes of FILE with the names of nodes of an object replace its triangles;\n"
            "  objects without such nodes keep their own triangles; distance has no effect\n"
            "not with --texels, --attribute, --bent-normals, --fit, --enclosed, --falloff, --max-distance")
        ->excludes(texels)
        ->excludes("--attribute")
        ->excludes("--bent-normals");
}

void add_falloff(CLI::App* command, Falloff& falloff) {
    command
        ->add_option_function<std::vector<std::string>>(
            "--falloff",
            [&falloff](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    for (std::size_t at = 0; at <= text.size();) {
                        const std::size_t end = std::min(text.find(',', at), text.size());
                        falloff.terms.push_back(parse_term(text.substr(at, end - at)));
                        at = end + 1;
                    }
            },
            "let surfaces at DISTANCE metres block half of the light\n"
            "nearer surfaces block more, farther ones less (obscurance); DISTANCE: above 0\n"
            "several distances: the weighted mean of their blocked light\n"
            "SHARE: weight of a distance, 0 or more, not all 0 [1]; as 2:97,300:3 for 97 % and 3 %\n"
            "not with --occluders\n"
            "default: surfaces block all light at any distance up to --max-distance")
        ->allow_extra_args(false)
        ->type_name("DISTANCE[:SHARE],...");
    command
        ->add_option(
            "--max-distance", falloff.farthest,
            "ignore surfaces beyond X metres, above 0; default: no limit\n"
            "nearer surfaces block all light, or with --falloff the part that it gives for their distance\n"
            "not with --occluders")
        ->check(above_zero());
}

} // namespace

void add_ao(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("ao", "Bake ambient occlusion and bent normals for any engine");
    auto& a =
        arguments_for<AoArguments>(command, [&session](const AoArguments& given) { run(given, session); });
    command->add_option("scene", a.scene, "scene to bake: glTF 2.0 (.gltf, .glb), or a mesh, .obj or .ply")
        ->required()
        ->check(named);
    add_output(command, a.output, "write the scene with its occlusion to this file, .glb");
    add_outputs(command, a);
    add_falloff(command, a.options.tracer.falloff);
    command
        ->add_option(
            "--rays", a.rays,
            "number of rays per vertex, texel or point\n"
            "1 to 2^24; texel: a quarter of N from each of 4 points, fewer points at borders of charts\n"
            "point: around an object of --occluders; N is rounded up to a multiple of 6")
        ->check(CLI::Range(1, kMaxRays))
        ->default_str("1024; --occluders: 256");
    add_fit(command, a.options.fit,
            "points where the occlusion of vertices is measured\n"
            "not with --texels or --occluders");
    command->get_option("--texels")->excludes("--fit");
    add_no_shadow(command, a.no_shadow, "\nno effect on the model of --high-poly");
    add_back_sides(command, a.back_sides,
                   "\nalways shared for --texels without unwrap; no effect with --occluders");
    add_device(command, a.options.tracer);
    add_enclosed(command, a.options.repairs.inside);
    for (const char* of_vertices : {"--fit", "--enclosed"})
        command->get_option("--occluders")->excludes(command->get_option(of_vertices));
    add_seed(command, a.options.seed);
    add_reading(command, a.reading);
    add_smooth_normals(command, a.reading);
    add_threads(command, a.options.threads);
    add_json(command, a.json);
}

} // namespace prt::cli
