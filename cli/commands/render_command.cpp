#include "commands/commands.h"

#include "lamp_strengths.h"
#include "options.h"
#include "outputs.h"
#include "posed_lobes.h"
#include "prt/gl_renderer.h"
#include "prt/light_meter.h"
#include "prt/light_passing.h"
#include "prt/lightmap_file.h"
#include "prt/lightmap_lookup.h"
#include "prt/ray_renderer.h"
#include "prt/receiver_colors.h"
#include "prt/receivers.h"
#include "prt/shader_source.h"
#include "prt/sun_shadows.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "prt/tone_map.h"
#include "solid_materials.h"
#include "split_light.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt::cli {
namespace {

enum class Show { lit, clusters, error, ao };

/// How bright a picture is.
struct Exposure {
    bool automatic = true; ///< by what the model shows
    double stops = 0;      ///< of radiance, or beside the automatic ones
};

/// From where, and with how many pixels.
struct View {
    int width = 1280, height = 720, samples = 2;
    std::optional<glm::dvec3> camera, look_at; ///< metres, world
    double field_of_view_degrees = 35;
};

struct Look {
    Show show = Show::lit;
    Exposure exposure;
    ToneMap tone_map = ToneMap::filmic;
    bool background = true;
};

/// What is lit beside the sky.
struct Lights {
    SunCount suns = {std::nullopt}; ///< as many as pay: their shadows show first, and no order has them
    int sun_rays = 32;              ///< for each pixel and sun
    LampChoice lamps;
    double lamp_scale = 1;
};

struct RenderArguments {
    Path model, environment, output, json, baked;
    LightOptions light_options = {{}, Window::automatic, 0}; ///< a picture shows ringing as bruises
    Lights lights;
    View view;
    Backend backend = Backend::automatic;
    Look look;
    GltfOptions reading;
    int threads = 0;
};

const std::map<std::string, Show> kShows = {
    {"lit", Show::lit}, {"clusters", Show::clusters}, {"error", Show::error}, {"ao", Show::ao}};
const std::map<std::string, ToneMap> kToneMaps = {{"filmic", ToneMap::filmic}, {"srgb", ToneMap::srgb}};

void parse_vector(const std::string& name, const std::string& text, std::optional<glm::dvec3>& target) {
    glm::dvec3 v(0);
    int used = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x, &v.y, &v.z, &used) != 3 ||
        static_cast<std::size_t>(used) != text.size() || !std::isfinite(v.x + v.y + v.z))
        throw CLI::ValidationError(name, "'" + text + "' is not x,y,z, three finite numbers");
    target = v;
}

void vector_option(CLI::App* command, const std::string& name, std::optional<glm::dvec3>& target,
                   const std::string& text) {
    command
        ->add_option_function<std::string>(
            name, [name, &target](const std::string& value) { parse_vector(name, value, target); }, text)
        ->type_name("x,y,z");
}

void parse_size(const std::string& text, int& width, int& height) {
    constexpr int kMost = 16384;
    int used = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width < 1 || height < 1 || width > kMost ||
        height > kMost)
        throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT in 1..16384");
}

constexpr double kMostStops = 100; ///< floats go from -126 to 127

Exposure parse_exposure(const std::string& text) {
    Exposure exposure;
    exposure.automatic = text.starts_with("auto");
    const std::string number = exposure.automatic ? text.substr(4) : text;
    const bool sign_follows = number.empty() || number[0] == '+' || number[0] == '-';
    const std::optional<double> stops = number.empty() ? exposure.stops : real_number(number);
    if ((exposure.automatic && !sign_follows) || text.empty() || !stops || !(std::abs(*stops) <= kMostStops))
        throw CLI::ValidationError("--exposure", "'" + text +
                                                     "' is neither a number of stops in -100..100 nor auto, "
                                                     "auto+STOPS or auto-STOPS");
    exposure.stops = *stops;
    return exposure;
}

constexpr int kUnshadowedOrder = 6;

/// The context to draw with; null: draw on the CPU.
std::unique_ptr<GlContext> choose_backend(Backend backend, bool shadows_on_cpu) {
    if (backend == Backend::cpu)
        return nullptr;
    std::string why;
    auto context = GlContext::create(backend == Backend::gpu ? GlDevice::any : GlDevice::hardware, &why);
    if (context && backend == Backend::automatic && shadows_on_cpu)
        return nullptr;
    if (!context && backend == Backend::gpu)
        throw Error("there is no OpenGL 4.5 for --backend gpu (" + why + ")");
    return context;
}

/// What is solid though its material does not say so: OpenGL's renderer would light it by suns twice.
bool has_unnamed_media(const SceneFile& model, const std::vector<bool>& solid) {
    for (std::size_t m = 0; m < solid.size(); ++m)
        if (solid[m] && !has_medium(model.scene.materials[m]))
            return true;
    return false;
}

/// Why suns cannot be lit apart from the sky, and what to do about it; empty: they can. What holds no
/// transfer has direct light only.
std::string why_together(const RenderArguments& a, const SceneFile& model, const std::vector<bool>& solid) {
    if (model.record() && layout_of(model).has(PartKind::whole))
        return a.model.string() + ": " + kNotApart;
    if (a.backend == Backend::gpu && has_unnamed_media(model, solid))
        return "--backend gpu does not know media of --subsurface, which suns light through transfer alone; "
               "draw with --backend cpu";
    return {};
}

/// With its suns apart where they can be, and are wanted.
SplitLight load_lit(const RenderArguments& a, const SceneFile& model, const std::vector<bool>& solid) {
    const int order = model.order() > 0 ? model.order() : kUnshadowedOrder;
    if (a.environment.empty())
        return dark_sky(order);
    const bool lit = a.look.show == Show::lit || a.look.show == Show::error;
    const std::string why = lit ? why_together(a, model, solid) : "";
    if (!why.empty() && a.lights.suns.count.value_or(0) > 0)
        throw Error(why + ", or light it with --suns 0");
    SplitLight light =
        load_split_light(a.environment, order, lit ? a.lights.suns : SunCount{0}, a.light_options, a.threads);
    if (why.empty() || light.split.suns.empty())
        return light;
    print_notices(a.environment.string(),
                  {fmt::format("its suns ({}) are lit with the sky, and no shadow of theirs is sharp: {}",
                               light.split.suns.size(), why)});
    return together(std::move(light));
}

/// Of a model without transfer, too, which has no lamps.
TransferLayout layout_of_any(const SceneFile& model) {
    return model.record() ? layout_of(model) : layout_of_one(kUnshadowedOrder, 1, PartKind::direct);
}

Lighting lighting_of(const RenderArguments& a, const SceneFile& model, const SplitLight& light) {
    Lighting lighting = cli::lighting_of(light);
    lighting.lamps = lamp_strengths(a.lights.lamps, layout_of_any(model));
    scale_lights(model.scene, layout_of_any(model), a.lights.lamp_scale, lighting.lamps);
    return lighting;
}

/// Exit radiance for albedo 1 of the receivers, texels or vertices: compressed, baked, or unshadowed,
/// whatever the model holds.
std::vector<glm::vec3> lit_colors(const SceneFile& model, const Lighting& lighting, int threads) {
    if (model.compressed)
        return exit_radiance(model.compressed->transfer, lighting, threads);
    if (model.baked)
        return exit_radiance(model.baked->transfer, lighting, threads);
    return exit_radiance(unshadowed_transfer(model.scene, lighting.sky.order), lighting, threads);
}

/// Says where the lights of the model outshine its sky.
void note_lights(const RenderArguments& a, const SceneFile& model, const Lighting& lighting) {
    if (a.environment.empty() || a.look.show != Show::lit || !model.record())
        return;
    const TransferLayout layout = layout_of(model);
    std::vector<float> areas;
    if (!model.lightmap)
        areas = receiver_areas(model.scene);
    else if (model.baked)
        areas = model.lightmap->areas;
    else
        areas.assign(model.lightmap->layout.texels(), 1.0f);
    const Relit relit{layout, [&](const Lighting& l) { return lit_colors(model, l, a.threads); }, areas};
    if (auto notice = photometric_notice(model.scene, relit, lighting))
        print_notices(a.model.string(), {std::move(*notice)});
}

/// Of all texels of a shipped lightmap, against those that its bake has.
std::vector<glm::vec3> lightmap_errors(const SceneFile& baked, const SceneFile& model,
                                       const Lighting& lighting, int threads) {
    const LightmapOfFile& lightmap = *baked.lightmap;
    const std::vector<glm::vec3> shipped =
        model.compressed
            ? exit_radiance(picked_texels(model.compressed->transfer, lightmap.texels), lighting, threads)
            : lit_colors(model, lighting, threads);
    const std::vector<glm::vec3> errors =
        error_colors(exit_radiance(baked.baked->transfer, lighting, threads), shipped, lightmap.areas);
    return model.compressed ? spread_over_maps(lightmap.layout, lightmap.texels, errors) : errors;
}

std::vector<glm::vec3> colors_to_show(const RenderArguments& a, const SceneFile& model,
                                      const Lighting& lighting) {
    switch (a.look.show) {
    case Show::clusters:
        if (!model.compressed)
            throw Error("--show clusters needs a compressed file");
        return cluster_colors(model.compressed->transfer);
    case Show::ao: // exit radiance under uniform light of radiance 1
        return lit_colors(model,
                          {.sky = constant_light(std::max(1, model.order()), glm::vec3(1)),
                           .lamps = std::vector<glm::vec3>(layout_of_any(model).lamps(), glm::vec3(0))},
                          a.threads);
    case Show::error: {
        SceneFile baked = load_scene_file(a.baked, a.reading);
        if (!baked.baked)
            throw Error(a.baked.string() + ": holds no raw transfer; --baked is the output of prt bake");
        check_belong_together(baked, a.baked, model, a.model);
        put_in_order_of(model.scene, baked);
        if (model.lightmap)
            return lightmap_errors(baked, model, lighting, a.threads);
        return error_colors(exit_radiance(baked.baked->transfer, lighting, a.threads),
                            lit_colors(model, lighting, a.threads), receiver_areas(baked.scene));
    }
    case Show::lit:
        break;
    }
    return lit_colors(model, lighting, a.threads);
}

/// Colors of all texels, and what a meter looks at.
struct LitMaps {
    std::vector<glm::vec3> texels, at_vertices;
};

/// `colors` are those of the receivers: of a bake some texels, others take that of one close by.
LitMaps lit_maps(const SceneFile& model, const std::vector<glm::vec3>& colors) {
    const LightmapOfFile& lightmap = *model.lightmap;
    LitMaps lit{model.baked ? spread_over_maps(lightmap.layout, lightmap.texels, colors) : colors, {}};
    lit.at_vertices = at_vertices(model.scene, lightmap.layout, lit.texels);
    return lit;
}

Camera choose_camera(const View& view, const Scene& scene) {
    const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
    const auto fov = static_cast<float>(glm::radians(view.field_of_view_degrees));
    Camera camera = automatic_camera(scene, aspect, fov);
    if (view.look_at)
        camera.target = glm::vec3(*view.look_at - scene.origin);
    if (view.camera)
        camera.position = glm::vec3(*view.camera - scene.origin);
    return camera;
}

/// Factor on radiance. Where the picture shows nothing of the model that is lit, the light is measured.
float choose_exposure(const Exposure& exposure, const Picture& picture, const TraceScene& scene,
                      const Light& light) {
    const auto stops = static_cast<float>(std::exp2(exposure.stops));
    if (!exposure.automatic)
        return stops;
    const LightMeter meter(picture, scene.rays());
    std::vector<glm::vec3> radiance;
    const PictureLightmaps& lightmaps = picture.in_shader.lightmaps;
    for (const std::uint32_t receiver : meter.receivers())
        radiance.push_back(lightmaps.layout ? lightmaps.radiance[receiver] : picture.radiance[receiver]);
    const float luminance = meter.luminance(radiance) + sun_luminance(picture, scene);
    const float automatic = luminance > 0 ? exposure_for(luminance) : automatic_exposure(light);
    return std::clamp(stops * automatic, 1e-30f, 1e30f); // beyond, floats do not hold what it is a factor of
}

/// A picture that shows nothing yet.
Picture empty_picture(const RenderArguments& a, const Scene& scene) {
    Picture picture;
    picture.scene = &scene;
    picture.textured = a.look.show == Show::lit;
    picture.camera = choose_camera(a.view, scene);
    picture.width = a.view.width;
    picture.height = a.view.height;
    picture.samples = a.view.samples;
    picture.background.rotation = static_cast<float>(glm::radians(a.light_options.rotation_degrees));
    return picture;
}

/// Lets OpenGL light what is compressed in the vertex shader, where it fits.
void light_in_shader(const RenderArguments& a, const SceneFile& model, const Lighting& lighting,
                     Picture& picture) {
    if (a.look.show != Show::lit || !model.compressed || model.lightmap)
        return;
    const ClusteredBases& bases = model.compressed->transfer.bases;
    if (bases.max_components() <= most_vertex_components(bases)) {
        picture.in_shader.transfer = &model.compressed->transfer;
        picture.in_shader.lighting = &lighting;
    } else {
        print_notices(
            a.model.string(),
            {fmt::format("has more than {} components, which do not fit the vertex attributes; exit "
                         "radiance is formed on the CPU",
                         most_vertex_components(bases))});
    }
}

struct Rendered {
    Image image;
    double seconds = 0;
    std::optional<float> exposure; ///< unset: the numbers are shown as they are
};

/// Draws with `context`, or on the CPU where that is null.
Rendered render(const RenderArguments& a, const Picture& picture, const TraceScene& scene, const Light& light,
                GlContext* context) {
    const bool exposed = a.look.show == Show::lit && suffix_of(a.output) != ".exr";
    const Stopwatch stopwatch;
    Rendered result;
    result.image = context
                       ? render_gl(picture, *context)
                       : render_rays(picture, scene, {.sun_rays = a.lights.sun_rays, .threads = a.threads});
    result.seconds = stopwatch.seconds();
    if (exposed)
        result.exposure = choose_exposure(a.look.exposure, picture, scene, light);
    return result;
}

void write_picture(const RenderArguments& a, const Rendered& rendered, Session& session) {
    if (suffix_of(a.output) == ".exr") {
        session.write(a.output, encode_exr(downsampled(rendered.image, a.view.samples)));
        return;
    }
    // Views of numbers are shown as they are.
    const auto pixels = tone_mapped(rendered.image, a.view.samples, rendered.exposure.value_or(1.0f),
                                    rendered.exposure ? a.look.tone_map : ToneMap::srgb);
    session.write(a.output, encode_png(a.view.width, a.view.height, pixels));
}

Report report_of(const RenderArguments& a, const Picture& picture, const Rendered& rendered,
                 const GlContext* context) {
    const glm::dvec3 position = picture.scene->world(picture.camera.position),
                     target = picture.scene->world(picture.camera.target);
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"width_pixels", a.view.width},
                         {"height_pixels", a.view.height},
                         {"seconds", rendered.seconds},
                         {"backend", context ? "gpu" : "cpu"},
                         {"renderer", context ? context->renderer() : "CPU ray casting"},
                         {"suns", picture.suns.size()},
                         {"camera_metres", {position.x, position.y, position.z}},
                         {"look_at_metres", {target.x, target.y, target.z}}});
    std::string sentence = "{output}: {width_pixels} x {height_pixels}, {seconds:.3f} s, {renderer}";
    if (!picture.suns.empty())
        sentence += ", {suns} suns apart";
    if (rendered.exposure) {
        add_figures(report, {{"exposure_stops", std::log2(static_cast<double>(*rendered.exposure))},
                             {"exposure_automatic", a.look.exposure.automatic}});
        sentence += ", exposure {exposure_stops:+.2f} stops";
        sentence += a.look.exposure.automatic ? " (auto)" : "";
    }
    report.sentences = {sentence};
    return report;
}

/// What CLI11 cannot see: options that need each other.
void check_together(const RenderArguments& a) {
    if ((a.look.show == Show::error) == a.baked.empty())
        throw CLI::ValidationError("--show error", "and --baked FILE go together");
}

void run(RenderArguments a, Session& session) {
    check_together(a);
    a.reading.outputs =
        check_outputs({{a.output, "--output", {".png", ".exr"}, true}, {a.json, "--json", {".json"}}},
                      {a.model, a.environment, a.lights.lamps.file, a.baked});
    SceneFile model = load_scene_file(a.model, a.reading);
    if (!model.record() && model.lobes)
        model.baked = lobes_as_transfer(model);
    if (!model.record())
        print_notices(a.model.string(), {"holds no transfer: its sky casts no shadows"});
    const std::vector<bool> solid = solid_materials(model);
    const SplitLight light = load_lit(a, model, solid);
    const Lighting lighting = lighting_of(a, model, light);
    note_lights(a, model, lighting);
    const bool suns = !light.split.suns.empty() && a.look.show == Show::lit;
    std::vector<Texture> textures = about(a.model, [&] {
        return load_textures(model.scene, bad_textures(a.reading),
                             suns ? TextureNeeds::all : TextureNeeds::pictures);
    });
    const TraceScene scene(model.scene, std::move(textures), {.solid = solid, .threads = a.threads});
    const std::vector<glm::vec3> colors = colors_to_show(a, model, lighting);
    Picture picture = empty_picture(a, model.scene);
    picture.textures = scene.textures();
    LitMaps maps;
    if (model.lightmap)
        maps = lit_maps(model, colors);
    picture.radiance = model.lightmap ? maps.at_vertices : colors;
    if (model.lightmap)
        picture.in_shader.lightmaps = {.layout = &model.lightmap->layout, .radiance = maps.texels};
    if (suns)
        picture.suns = light.split.suns;
    const std::vector<glm::vec3> emission =
        emission_strengths(model.scene, layout_of_any(model), lighting.lamps);
    if (a.look.show == Show::lit)
        picture.emission = emission;
    Image background;
    if (a.look.background && a.look.show == Show::lit && light.sky.environment) {
        background = resampled_lat_long(*light.sky.environment);
        picture.background.image = &background;
    }
    const std::unique_ptr<GlContext> context = choose_backend(
        a.backend, suns && (picture.suns.size() > kMostShadowedSuns || has_unnamed_media(model, solid)));
    std::optional<CompressedLightmap> on_gpu;
    if (context)
        light_in_shader(a, model, lighting, picture);
    if (context && model.lightmap && model.compressed && a.look.show == Show::lit) {
        on_gpu = {model.lightmap->layout, *model.compressed};
        picture.in_shader.lightmaps.on_gpu = &*on_gpu;
        picture.in_shader.lightmaps.lighting = &lighting;
    }
    const Light all_light = lighting.suns ? sum(lighting.sky, *lighting.suns) : lighting.sky;
    const Rendered rendered = render(a, picture, scene, all_light, context.get());
    write_picture(a, rendered, session);
    publish(report_of(a, picture, rendered, context.get()), a.json, session);
}

void add_view(CLI::App* command, View& view) {
    command
        ->add_option_function<std::string>(
            "--size", [&view](const std::string& text) { parse_size(text, view.width, view.height); },
            "size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    vector_option(command, "--camera", view.camera,
                  "position of the camera, metres; otherwise it sees the whole scene");
    vector_option(command, "--look-at", view.look_at,
                  "point the camera looks at; otherwise the middle of the scene");
    command->add_option("--fov", view.field_of_view_degrees, "vertical field of view, degrees")
        ->capture_default_str()
        ->check(real_in(1, 170));
}

void add_exposure(CLI::App* command, Look& look) {
    command
        ->add_option_function<std::string>(
            "--exposure", [&look](const std::string& text) { look.exposure = parse_exposure(text); },
            "stops; or auto: the mean luminance of what shows of the model becomes 0.22; or stops "
            "beside it: auto+1, auto-0.5")
        ->type_name("STOPS")
        ->default_str("auto");
    choice(command, "--tone-map", look.tone_map, kToneMaps, "tone curve of .png", "filmic");
}

} // namespace

void add_render(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("render", "Draw a file under an environment, without a window");
    auto& a = arguments_for<RenderArguments>(
        command, [&session](const RenderArguments& given) { run(given, session); });
    command
        ->add_option("model", a.model, "any .gltf or .glb: compressed, baked, or neither (then unshadowed)")
        ->required()
        ->check(named);
    command
        ->add_option("--env", a.environment,
                     "environment (.exr, .hdr, .png, .jpg) or light (.json); without it the sky is dark and "
                     "lamps alone light the model")
        ->check(named)
        ->type_name("FILE");
    add_output(command, a.output, "picture to write, .png or .exr");
    add_view(command, a.view);
    add_backend(command, a.backend,
                "gpu: OpenGL 4.5 of any kind; cpu: ray casting; auto: a hardware GPU, else the CPU");
    choice(
        command, "--show", a.look.show, kShows,
        "lit; the clusters; the error against --baked (white: 10 % of the mean radiance); ambient occlusion",
        "lit");
    command->add_option("--baked", a.baked, "the bake that --show error compares with")
        ->type_name("FILE")
        ->check(named);
    add_exposure(command, a.look);
    command->add_option("--samples", a.view.samples, "samples per pixel along each axis")
        ->capture_default_str()
        ->check(CLI::Range(1, 16));
    command->add_flag("!--no-background", a.look.background, "do not show the environment behind the scene");
    add_light_options(command, a.light_options);
    add_suns(command, a.lights.suns,
             "find suns in the image, so many or as many as pay, and light every pixel by them with sharp "
             "shadows; those of a light file are lit so, too; 0: all light is in the sky",
             "auto");
    add_lamps(command, a.lights.lamps);
    add_lamp_scale(command, a.lights.lamp_scale);
    command->add_option("--sun-rays", a.lights.sun_rays, "rays from a pixel to each sun")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 20));
    add_reading(command, a.reading);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

} // namespace prt::cli
