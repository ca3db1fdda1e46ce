#include "commands.h"

#include "inputs.h"
#include "outputs.h"
#include "prt/error.h"
#include "prt/gl_renderer.h"
#include "prt/ray_renderer.h"
#include "prt/receiver_colors.h"
#include "prt/receivers.h"
#include "prt/stopwatch.h"
#include "report.h"

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
        camera.target = *a.look_at;
    if (a.camera)
        camera.position = *a.camera;
    return camera;
}

void write_picture(const RenderArguments& a, const Image& image, const Light& light, Interrupt& interrupt) {
    const Interrupt::WritingScope writing(interrupt);
    if (suffix_of(a.output) == ".exr")
        return write_exr(a.output, downsampled(image, a.samples));
    // Views of numbers are shown as they are.
    const bool lit = a.show == Show::lit;
    const float exposure = !lit               ? 1.0f
                           : a.exposure_stops ? static_cast<float>(std::exp2(*a.exposure_stops))
                                              : automatic_exposure(light);
    const auto pixels = tone_mapped(image, a.samples, exposure, lit ? a.tone_map : ToneMap::srgb);
    write_png(a.output, a.width, a.height, pixels);
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
    const std::vector<Texture> textures = load_textures(model.scene);
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
    const Image image = context ? render_gl(picture, *context)
                                : render_rays(picture, RayScene(model.scene, a.threads), a.threads);
    const double seconds = stopwatch.seconds();
    write_picture(a, image, light.light, interrupt);

    const std::string renderer = context ? context->renderer() : "CPU ray casting";
    fmt::print("{}: {} x {}, {:.3f} s, {}\n", a.output.string(), a.width, a.height, seconds, renderer);
    const Camera& c = picture.camera;
    write_json({{"output", a.output.string()},
                {"width_pixels", a.width},
                {"height_pixels", a.height},
                {"seconds", seconds},
                {"backend", context ? "gpu" : "cpu"},
                {"renderer", renderer},
                {"camera_metres", {c.position.x, c.position.y, c.position.z}},
                {"look_at_metres", {c.target.x, c.target.y, c.target.z}}},
               a.json, interrupt);
}

} // namespace prt::cli
