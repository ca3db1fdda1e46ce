// Draws a model under a light.

#include "cli/pipeline/render_model.h"

#include "bake/reference/light_meter.h"
#include "bake/reference/ray_renderer.h"
#include "bake/scene/receivers.h"
#include "cli/pipeline/posed_lobes.h"
#include "cli/pipeline/solid_materials.h"
#include "cli/pipeline/traced_picture.h"
#include "compress/study/receiver_colors.h"
#include "prt/core/error.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/lightmap_file.h"
#include "prt/shader/shader_source.h"
#include "runtime/core/support/stopwatch.h"
#include "runtime/load/light_passing.h"
#include "runtime/render/gl/sun_shadows.h"
#include "runtime/render/lightmap_lookup.h"

#include <fmt/core.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace prt::pipeline {
namespace {

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
        throw Error("--device gpu needs OpenGL 4.5 (" + why + "); use --device cpu");
    return context;
}

/// Returns the reason why suns cannot be separate from the sky, with advice; empty if they can. A model
/// without transfer has only direct light.
std::string why_together(const RenderRequest& a, const SceneFile& model) {
    if (model.lobes || (model.record() && layout_of(model).has(TermKind::combined)))
        return a.model.string() + ": " + kNoDirectTerm;
    return {};
}

/// Loads the light, with separate suns if possible and requested.
LoadedLight load_lit(const RenderRequest& a, const SceneFile& model) {
    const int order = model.order() > 0 ? model.order()
                      : model.lobes     ? model.lobes->model.order
                                        : kUnshadowedOrder;
    if (a.environment.empty())
        return dark_sky(order);
    const bool lit = a.drawn_lit() || a.look.show == Show::error;
    const std::string why = lit ? why_together(a, model) : "";
    if (!why.empty() && a.lights.suns.count.value_or(0) > 0)
        throw Error(why + ", or light it with --suns 0");
    LoadedLight light =
        load_light(a.environment, order, lit ? a.lights.suns : SunCount{0}, a.light_options, a.threads);
    if (why.empty() || light.split.suns.empty())
        return light;
    send(a.reading.notify, a.environment,
         {fmt::format("its suns ({}) are part of the sky and have no sharp shadows: {}",
                      light.split.suns.size(), why)});
    return together(std::move(light));
}

/// Returns the layout of the transfer; for a model without transfer one without lamps.
TransferLayout layout_of_any(const SceneFile& model) {
    return model.record() ? layout_of(model) : layout_of_one(kUnshadowedOrder, 1, TermKind::direct);
}

Lighting lighting_of(const RenderRequest& a, const SceneFile& model, const LoadedLight& light) {
    Lighting lighting = pipeline::lighting_of(light);
    lighting.lamps = lamp_strengths(a.lights.lamps, layout_of_any(model));
    scale_lights(model.scene, layout_of_any(model), a.lights.lamp_scale, lighting.lamps);
    return lighting;
}

/// Returns exit radiance for albedo 1 of the receivers, texels or vertices: from compressed or baked
/// transfer, from lobes, or unshadowed.
std::vector<glm::vec3> lit_colors(const SceneFile& model, const Lighting& lighting, int threads) {
    std::vector<glm::vec3> colors =
        model.compressed ? exit_radiance(model.compressed->transfer, lighting, threads)
        : model.baked
            ? exit_radiance(model.baked->transfer, lighting, threads)
            : exit_radiance(unshadowed_transfer(model.scene, lighting.sky.order), lighting, threads);
    if (!model.lightmap)
        light_lobes(model, lighting, colors);
    return colors;
}

/// Prints a notice if the lights of the model are far brighter than its sky.
void note_lights(const RenderRequest& a, const SceneFile& model, const Lighting& lighting) {
    if (a.environment.empty() || !a.drawn_lit() || !model.record())
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
        send(a.reading.notify, a.model.path, {std::move(*notice)});
}

/// Returns errors of all texels of a shipped lightmap, against those in its bake.
std::vector<glm::vec3> lightmap_errors(const SceneFile& baked, const SceneFile& model,
                                       const Lighting& lighting, int threads) {
    const LightmapOfFile& lightmap = *baked.lightmap;
    const std::vector<glm::vec3> shipped =
        model.compressed
            ? exit_radiance(gather_texels(model.compressed->transfer, lightmap.texels), lighting, threads)
            : lit_colors(model, lighting, threads);
    const std::vector<glm::vec3> errors =
        error_colors(exit_radiance(baked.baked->transfer, lighting, threads), shipped, lightmap.areas);
    return model.compressed ? scatter_to_maps(lightmap.layout, lightmap.texels, errors) : errors;
}

std::vector<glm::vec3> colors_to_show(const RenderRequest& a, const SceneFile& model,
                                      const Lighting& lighting) {
    switch (a.look.show) {
    case Show::clusters:
        if (!model.compressed)
            throw Error(model.instanced && model.instanced->compressed
                            ? "--show clusters does not support instances that share transfer"
                            : "--show clusters needs a compressed file");
        return cluster_colors(model.compressed->transfer);
    case Show::ao: // exit radiance under uniform light of radiance 1
        return lit_colors(model,
                          {.sky = constant_light(std::max(1, model.order()), glm::vec3(1)),
                           .lamps = std::vector<glm::vec3>(layout_of_any(model).lamps(), glm::vec3(0))},
                          a.threads);
    case Show::error: {
        if (a.error() == ErrorOf::traced)
            break;
        SceneFile baked = load_scene_file(a.baked, a.reading);
        if (!baked.baked)
            throw Error(a.baked.string() +
                        ": contains no raw transfer; --baked must be the output of prt bake");
        check_belong_together(baked, a.baked.path, model, a.model.path);
        about(a.model.path, [&] { put_in_order_of(model.scene, baked); });
        if (model.lightmap)
            return lightmap_errors(baked, model, lighting, a.threads);
        return error_colors(lit_colors(baked, lighting, a.threads), lit_colors(model, lighting, a.threads),
                            receiver_areas(baked.scene));
    }
    case Show::lit:
        break;
    }
    return lit_colors(model, lighting, a.threads);
}

/// Colors of all texels, and colors at vertices for the light meter.
struct LitMaps {
    std::vector<glm::vec3> texels, at_vertices;
};

/// Returns the maps. `colors` belong to the receivers; a bake has only some texels, and other texels take the
/// color of one nearby.
LitMaps lit_maps(const SceneFile& model, const Lighting& lighting, const std::vector<glm::vec3>& colors) {
    const LightmapOfFile& lightmap = *model.lightmap;
    LitMaps lit{model.baked ? scatter_to_maps(lightmap.layout, lightmap.texels, colors) : colors, {}};
    lit.at_vertices = at_vertices(model.scene, lightmap.layout, lit.texels);
    light_lobes(model, lighting, lit.at_vertices);
    return lit;
}

/// Returns the factor on radiance. If no lit surface is visible, the light is measured. `traced`: luminance
/// of a path-traced picture, which replaces that of the transfer.
float choose_exposure(const Exposure& exposure, const Picture& picture, const TraceScene& scene,
                      const Light& light, std::optional<float> traced) {
    const auto stops = static_cast<float>(std::exp2(exposure.stops));
    if (!exposure.automatic)
        return stops;
    const auto shown = [&](float luminance) {
        const float automatic = luminance > 0 ? exposure_for(luminance) : automatic_exposure(light);
        return std::clamp(stops * automatic, 1e-30f, 1e30f); // floats hold the product with radiance
    };
    if (traced)
        return shown(*traced);
    const LightMeter meter(picture, scene.rays());
    std::vector<glm::vec3> radiance;
    const PictureLightmaps& lightmaps = picture.in_shader.lightmaps;
    for (const std::uint32_t receiver : meter.receivers())
        radiance.push_back(lightmaps.layout ? lightmaps.radiance[receiver] : picture.radiance[receiver]);
    return shown(meter.luminance(radiance) + sun_luminance(picture, scene));
}

/// Returns a picture without content.
Picture empty_picture(const RenderRequest& a, const Scene& scene) {
    Picture picture;
    picture.scene = &scene;
    picture.textured = a.drawn_lit();
    picture.camera = choose_camera(a.view, scene);
    picture.width = a.view.width;
    picture.height = a.view.height;
    picture.samples = a.view.samples;
    picture.background.rotation = static_cast<float>(glm::radians(a.light_options.rotation_degrees));
    return picture;
}

/// Makes OpenGL light compressed transfer in the vertex shader, if it fits.
void light_in_shader(const RenderRequest& a, const SceneFile& model, const Lighting& lighting,
                     Picture& picture) {
    if (!a.drawn_lit() || !model.compressed || model.lightmap)
        return;
    const ClusteredBases& bases = model.compressed->transfer.bases;
    if (bases.max_components() <= max_vertex_components(bases)) {
        picture.in_shader.transfer = &model.compressed->transfer;
        picture.in_shader.lighting = &lighting;
    } else {
        send(a.reading.notify, a.model.path,
             {fmt::format("has more than {} components, which do not fit into the vertex attributes; the CPU "
                          "computes exit radiance",
                          max_vertex_components(bases))});
    }
}

/// Input of a picture.
struct Drawing {
    const Picture& picture;
    const TraceScene& scene;
    const Light& light;           ///< combined, as SH
    const DistantLight* sky;      ///< sky and suns for path tracing; null without it
    const SceneLamps* lamps;      ///< lamps for path tracing; null without it
    GlContext* context = nullptr; ///< draws the picture; null: the CPU draws it
    bool holds_transfer = true;   ///< used for metering the exposure
};

struct Rendered {
    Image image;
    int samples = 1; ///< samples of `image` per pixel along each axis
    double seconds = 0;
    std::optional<float> exposure = {}; ///< unset: numbers are shown unchanged
    std::optional<double> noise = {};   ///< noise of path tracing, relative L2
    std::optional<PictureError> error = {};
};

Image drawn(const RenderRequest& a, const Drawing& drawing) {
    return drawing.context ? render_gl(drawing.picture, *drawing.context)
                           : render_rays(drawing.picture, drawing.scene,
                                         {.sun_rays = a.lights.sun_rays, .threads = a.threads});
}

/// Returns the reference, or the error of the picture against it.
Rendered path_traced(const RenderRequest& a, const Drawing& drawing, const Host& host) {
    Rendered result;
    const Stage stage = host.stages("path tracing");
    const PathTracedPicture traced = traced_picture(drawing.picture, drawing.scene, *drawing.sky,
                                                    *drawing.lamps, a.look.paths, stage.progress);
    result.noise = noise_of(traced.halves, traced.surfaces);
    if (a.error() == ErrorOf::none) {
        result.image = mean_of(traced.halves);
        return result;
    }
    result.error = picture_error(downsampled(drawn(a, drawing), drawing.picture.samples), traced.halves,
                                 traced.surfaces, {.threads = a.threads});
    result.image = heat_image(drawing.picture.width, drawing.picture.height, result.error->flip);
    return result;
}

Rendered render(const RenderRequest& a, const Drawing& drawing, const Host& host) {
    const Stopwatch stopwatch;
    Rendered result;
    if (a.traced()) {
        result = path_traced(a, drawing, host);
    } else {
        result.image = drawn(a, drawing);
        result.samples = drawing.picture.samples;
    }
    result.seconds = stopwatch.seconds();
    if (a.look.show != Show::lit || suffix_of(a.output) == ".exr")
        return result;
    std::optional<float> luminance;
    if (a.look.exposure.automatic && a.traced() && !drawing.holds_transfer)
        luminance = traced_luminance(drawing.picture, drawing.scene, *drawing.sky, *drawing.lamps);
    result.exposure =
        choose_exposure(a.look.exposure, drawing.picture, drawing.scene, drawing.light, luminance);
    return result;
}

/// Figures of path tracing, and the words that show them.
std::string add_traced(const RenderRequest& a, const Rendered& rendered, Report& report) {
    add_figures(report, {{"paths_per_pixel", a.look.paths}, {"noise_relative_l2", *rendered.noise}});
    std::string words = ", {paths_per_pixel} paths a pixel, noise {noise_relative_l2:.2%}";
    if (const auto& error = rendered.error) {
        add_figures(report, {{"flip_mean", error->flip_mean},
                             {"flip_percentile_95", error->flip_percentile_95},
                             {"relative_l2", error->relative_l2},
                             {"contrast_rms", error->contrast_rms},
                             {"contrast_percentile_95", error->contrast_percentile_95}});
        words += "; against path tracing: contrast error {contrast_rms:.2%} RMS, 95 % of blocks below "
                 "{contrast_percentile_95:.2%}; HDR-FLIP {flip_mean:.3f}; relative L2 {relative_l2:.2%}";
    }
    return words;
}

std::string renderer_name(const RenderRequest& a, const GlContext* context) {
    std::string drawn_by = context ? context->renderer() : "CPU ray casting";
    if (!a.traced())
        return drawn_by;
    return a.error() == ErrorOf::none ? "path tracing" : drawn_by + " against path tracing";
}

Report report_of(const RenderRequest& a, const Picture& picture, const Rendered& rendered,
                 const GlContext* context) {
    const glm::dvec3 position = picture.scene->world(picture.camera.position),
                     target = picture.scene->world(picture.camera.target);
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"width_pixels", a.view.width},
                         {"height_pixels", a.view.height},
                         {"seconds", rendered.seconds},
                         {"backend", context ? "gpu" : "cpu"},
                         {"renderer", renderer_name(a, context)},
                         {"suns", picture.suns.size()},
                         {"camera_metres", {position.x, position.y, position.z}},
                         {"look_at_metres", {target.x, target.y, target.z}}});
    std::string sentence = "{output}: {width_pixels} x {height_pixels}, {seconds:.3f} s, {renderer}";
    if (!picture.suns.empty())
        sentence += ", {suns:#separate sun}";
    if (rendered.noise)
        sentence += add_traced(a, rendered, report);
    if (rendered.exposure) {
        add_figures(report, {{"exposure_stops", std::log2(static_cast<double>(*rendered.exposure))},
                             {"exposure_automatic", a.look.exposure.automatic}});
        sentence += ", exposure {exposure_stops:+.2f} stops";
        sentence += a.look.exposure.automatic ? " (auto)" : "";
    }
    report.sentences = {sentence};
    return report;
}

/// Reads the model.
SceneFile load_model(const RenderRequest& a) {
    SceneFile model = load_scene_file(a.model, a.reading);
    const bool open = !model.record() && !std::ranges::all_of(model.scene.vertex_arrays, &VertexArray::lobes);
    if (open && (!a.traced() || a.error() == ErrorOf::traced))
        send(a.reading.notify, a.model.path, {"has no transfer: the sky casts no shadows"});
    return model;
}

/// Returns the lamps of a path-traced picture: those of the transfer, or all lamps of a scene without
/// transfer.
SceneLamps traced_lamps(const RenderRequest& a, const SceneFile& model, const TraceScene& scene,
                        const Lighting& lighting) {
    TransferLayout layout = layout_of_any(model);
    if (!model.record())
        for (TransferTerm& lamp : lamps_of(model.scene))
            layout.terms.push_back(std::move(lamp));
    std::vector<glm::vec3> strengths = lighting.lamps;
    if (!model.record()) {
        strengths = lamp_strengths(a.lights.lamps, layout);
        scale_lights(model.scene, layout, a.lights.lamp_scale, strengths);
    }
    return {scene, layout.lamp_terms(), strengths};
}

/// Prints a notice about media that path tracing ignores.
void note_media(const RenderRequest& a, const std::vector<bool>& solid) {
    if (a.traced() && std::ranges::count(solid, true) > 0)
        send(a.reading.notify, a.model.path,
             {fmt::format("{} of its materials have subsurface scattering, which path tracing does not "
                          "support: they are opaque in the reference",
                          std::ranges::count(solid, true))});
}

/// Colors of the model: numbers that a picture refers to.
struct Shown {
    std::vector<glm::vec3> colors, emission;
    LitMaps maps;
    Image background;
    std::optional<CompressedLightmap> on_gpu;
};

/// Fills `picture`, which refers to the returned object.
std::unique_ptr<Shown> show(const RenderRequest& a, const SceneFile& model, const Lighting& lighting,
                            const LoadedLight& light, Picture& picture) {
    auto shown = std::make_unique<Shown>();
    shown->colors = colors_to_show(a, model, lighting);
    if (model.lightmap) {
        shown->maps = lit_maps(model, lighting, shown->colors);
        picture.in_shader.lightmaps = {.layout = &model.lightmap->layout, .radiance = shown->maps.texels};
    }
    picture.radiance = model.lightmap ? shown->maps.at_vertices : shown->colors;
    if (!a.drawn_lit())
        return shown;
    picture.suns = light.split.suns;
    shown->emission = emission_strengths(model.scene, layout_of_any(model), lighting.lamps);
    picture.emission = shown->emission;
    if (a.look.background && light.environment && a.look.show == Show::lit) {
        shown->background = resampled_lat_long(*light.environment);
        picture.background.image = &shown->background;
    }
    return shown;
}

/// Makes OpenGL compute the light of a compressed model.
void light_on_gpu(const RenderRequest& a, const SceneFile& model, const Lighting& lighting, Shown& shown,
                  Picture& picture) {
    light_in_shader(a, model, lighting, picture);
    if (!model.lightmap || !model.compressed || !a.drawn_lit())
        return;
    shown.on_gpu = {model.lightmap->layout, *model.compressed};
    picture.in_shader.lightmaps.on_gpu = &*shown.on_gpu;
    picture.in_shader.lightmaps.lighting = &lighting;
}

/// Throws `Error` for sizes, angles and numbers out of range, which the options of the program also reject.
void check_ranges(const RenderRequest& a) {
    const View& v = a.view;
    if (v.width < 1 || v.height < 1 || v.width > 16384 || v.height > 16384)
        throw Error("the picture must have 1 to 16384 pixels on each side");
    if (v.samples < 1 || v.samples > 16)
        throw Error("the number of samples along each axis of a pixel must be in 1..16");
    if (!(v.field_of_view_degrees >= 1 && v.field_of_view_degrees <= 170))
        throw Error("the field of view must be in 1..170 degrees");
    if (!(std::abs(a.look.exposure.stops) <= 100))
        throw Error("the exposure must be in -100..100 stops");
    if (a.look.paths < 0 || a.look.paths == 1 || a.look.paths > 1 << 20)
        throw Error("the number of paths per pixel must be 0, or 2 to 1048576");
    if (!(a.lights.lamp_scale > 0 && a.lights.lamp_scale <= 1e9))
        throw Error("the factor on lights must be above 0 and at most 1e9");
}

} // namespace

RenderedPicture render_model(const RenderRequest& a, const Host& host) {
    check_ranges(a);
    const SceneFile model = load_model(a);
    const std::vector<bool> solid = solid_materials(model.scene);
    note_media(a, solid);
    const LoadedLight light = load_lit(a, model);
    const Lighting lighting = lighting_of(a, model, light);
    note_lights(a, model, lighting);
    const bool suns = !light.split.suns.empty() && a.drawn_lit();
    std::vector<Texture> textures = about(a.model.path, [&] {
        return load_textures(model.scene, a.reading.bad_textures,
                             suns || a.traced() ? TextureNeeds::all
                             : a.drawn_lit()    ? TextureNeeds::pictures
                                                : TextureNeeds::shadows);
    });
    const TraceScene scene(model.scene, std::move(textures), {.solid = solid, .threads = a.threads});
    Picture picture = empty_picture(a, model.scene);
    picture.textures = scene.textures();
    const std::unique_ptr<Shown> shown = show(a, model, lighting, light, picture);
    const bool draws = !a.traced() || a.error() == ErrorOf::traced;
    const std::unique_ptr<GlContext> context =
        draws ? choose_backend(a.backend, suns && picture.suns.size() > kMaxShadowedSuns) : nullptr;
    if (context)
        light_on_gpu(a, model, lighting, *shown, picture);
    const Light all_light = lighting.suns ? sum(lighting.sky, *lighting.suns) : lighting.sky;
    std::optional<DistantLight> sky;
    std::optional<SceneLamps> lamps;
    if (a.traced()) {
        sky.emplace(distant_light(a.environment, a.light_options, a.threads));
        lamps.emplace(traced_lamps(a, model, scene, lighting));
    }
    Rendered rendered = render(a,
                               {picture, scene, all_light, sky ? &*sky : nullptr, lamps ? &*lamps : nullptr,
                                context.get(), model.record() != nullptr},
                               host);
    Report report = report_of(a, picture, rendered, context.get());
    if (suffix_of(a.output) == ".exr")
        return {std::move(report), downsampled(rendered.image, rendered.samples), {}};
    // Views of numbers are shown unchanged.
    return {std::move(report),
            {},
            tone_mapped(rendered.image, rendered.samples, rendered.exposure.value_or(1.0f),
                        rendered.exposure ? a.look.tone_map : ToneMap::srgb)};
}

} // namespace prt::pipeline
