#include "commands/commands.h"

#include "inputs.h"
#include "outputs.h"
#include "prt/gl_renderer.h"
#include "prt/light_meter.h"
#include "prt/ray_renderer.h"
#include "prt/receiver_colors.h"
#include "prt/receivers.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "report/write_report.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace prt::cli {
namespace {

constexpr int kUnshadowedOrder = 6;

/// The context to draw with; null: draw on the CPU.
std::unique_ptr<GlContext> choose_backend(Backend backend) {
    if (backend == Backend::cpu)
        return nullptr;
    std::string why;
    auto context = GlContext::create(backend == Backend::gpu ? GlDevice::any : GlDevice::hardware, &why);
    if (!context && backend == Backend::gpu)
        throw Error("there is no OpenGL 4.5 for --backend gpu (" + why + ")");
    return context;
}

/// Exit radiance for albedo 1: compressed, baked, or unshadowed, whatever the model holds.
std::vector<glm::vec3> lit_colors(const Model& model, const Light& light, int threads) {
    if (model.compressed)
        return exit_radiance(model.compressed->transfer, light, threads);
    if (model.baked)
        return exit_radiance(model.baked->transfer, light, threads);
    return exit_radiance(unshadowed_transfer(model.scene, light.order), light, threads);
}

std::vector<glm::vec3> colors_to_show(const RenderArguments& a, const Model& model, const Light& light) {
    switch (a.show) {
    case Show::clusters:
        if (!model.compressed)
            throw Error("--show clusters needs a compressed file");
        return cluster_colors(model.compressed->transfer);
    case Show::ao: // exit radiance under uniform light of radiance 1
        return lit_colors(model, constant_light(std::max(1, model.order()), glm::vec3(1)), a.threads);
    case Show::error: {
        Model baked = load_model(a.baked);
        if (!baked.baked)
            throw Error(a.baked.string() + ": holds no raw transfer; --baked is the output of prt bake");
        check_belong_together(baked, a.baked, model, a.model);
        put_in_order_of(model.scene, baked);
        return error_colors(exit_radiance(baked.baked->transfer, light, a.threads),
                            lit_colors(model, light, a.threads), receiver_areas(baked.scene));
    }
    case Show::lit:
        break;
    }
    return lit_colors(model, light, a.threads);
}

Camera choose_camera(const RenderArguments& a, const Scene& scene) {
    const float aspect = static_cast<float>(a.width) / static_cast<float>(a.height);
    const auto fov = static_cast<float>(glm::radians(a.field_of_view_degrees));
    Camera camera = automatic_camera(scene, aspect, fov);
    if (a.look_at)
        camera.target = glm::vec3(*a.look_at - scene.origin);
    if (a.camera)
        camera.position = glm::vec3(*a.camera - scene.origin);
    return camera;
}

/// Factor on radiance; `rays` may be null unless it is automatic. Where the picture shows nothing of the
/// model that is lit, the light is measured.
float choose_exposure(const RenderArguments& a, const Picture& picture, const RayScene* rays,
                      const Light& light) {
    const auto stops = static_cast<float>(std::exp2(a.exposure.stops));
    if (!a.exposure.automatic)
        return stops;
    const LightMeter meter(picture, *rays);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : meter.receivers())
        radiance.push_back(picture.radiance[receiver]);
    const float luminance = meter.luminance(radiance);
    return stops * (luminance > 0 ? exposure_for(luminance) : automatic_exposure(light));
}

void write_picture(const RenderArguments& a, const Image& image, std::optional<float> exposure,
                   Interrupt& interrupt) {
    const Interrupt::WritingScope writing(interrupt);
    if (suffix_of(a.output) == ".exr")
        return write_exr(a.output, downsampled(image, a.samples));
    // Views of numbers are shown as they are.
    const auto pixels =
        tone_mapped(image, a.samples, exposure.value_or(1.0f), exposure ? a.tone_map : ToneMap::srgb);
    write_png(a.output, a.width, a.height, pixels);
}

void report(const RenderArguments& a, const Picture& picture, std::optional<float> exposure, double seconds,
            const GlContext* context, Interrupt& interrupt) {
    const std::string renderer = context ? context->renderer() : "CPU ray casting";
    const glm::dvec3 position = picture.scene->world(picture.camera.position),
                     target = picture.scene->world(picture.camera.target);
    Json json = {{"output", a.output.string()},
                 {"width_pixels", a.width},
                 {"height_pixels", a.height},
                 {"seconds", seconds},
                 {"backend", context ? "gpu" : "cpu"},
                 {"renderer", renderer},
                 {"camera_metres", {position.x, position.y, position.z}},
                 {"look_at_metres", {target.x, target.y, target.z}}};
    std::string stops;
    if (exposure) {
        const double value = std::log2(static_cast<double>(*exposure));
        stops = fmt::format(", exposure {:+.2f} stops{}", value, a.exposure.automatic ? " (auto)" : "");
        json["exposure_stops"] = value;
        json["exposure_automatic"] = a.exposure.automatic;
    }
    fmt::print("{}: {} x {}, {:.3f} s, {}{}\n", a.output.string(), a.width, a.height, seconds, renderer,
               stops);
    write_json(json, a.json, interrupt);
}

} // namespace

void run(const RenderArguments& a, Interrupt& interrupt) {
    check_outputs({{a.output, "--output", {".png", ".exr"}, true}, {a.json, "--json", {".json"}}},
                  {a.model, a.environment, a.baked});
    const Model model = load_model(a.model);
    if (!model.baked && !model.compressed)
        print_notices(a.model.string(), {"holds no transfer and is drawn without shadows"});
    const int order = model.order() > 0 ? model.order() : kUnshadowedOrder;
    const LoadedLight light = load_light(a.environment, order, a.light_options, a.threads);
    const std::vector<Texture> textures =
        load_textures(model.scene, BadTextures::error, TextureNeeds::pictures);
    const std::vector<glm::vec3> colors = colors_to_show(a, model, light.light);

    Picture picture;
    picture.scene = &model.scene;
    picture.textures = textures;
    picture.radiance = colors;
    picture.textured = a.show == Show::lit;
    picture.camera = choose_camera(a, model.scene);
    picture.width = a.width;
    picture.height = a.height;
    picture.samples = a.samples;
    Image background;
    if (a.background && a.show == Show::lit && light.environment) {
        background = resampled_lat_long(*light.environment);
        picture.background = &background;
        picture.background_rotation = static_cast<float>(glm::radians(a.light_options.rotation_degrees));
    }

    const std::unique_ptr<GlContext> context = choose_backend(a.backend);
    if (context && a.show == Show::lit && model.compressed) {
        if (model.compressed->transfer.bases.max_components() <= kMostVertexComponents) {
            picture.transfer = &model.compressed->transfer;
            picture.light = &light.light;
        } else {
            print_notices(a.model.string(),
                          {fmt::format("has more than {} components, which do not fit the vertex "
                                       "attributes; exit radiance is formed on the CPU",
                                       kMostVertexComponents)});
        }
    }
    const Stopwatch stopwatch;
    const bool exposed =
        a.show == Show::lit && a.output.extension() != ".exr"; // else the numbers as they are
    std::optional<RayScene> rays;
    if (!context || (exposed && a.exposure.automatic))
        rays.emplace(model.scene, a.threads);
    const Image image = context ? render_gl(picture, *context) : render_rays(picture, *rays, a.threads);
    const double seconds = stopwatch.seconds();
    std::optional<float> exposure;
    if (exposed)
        exposure = choose_exposure(a, picture, rays ? &*rays : nullptr, light.light);
    write_picture(a, image, exposure, interrupt);
    report(a, picture, exposure, seconds, context.get(), interrupt);
}

} // namespace prt::cli
