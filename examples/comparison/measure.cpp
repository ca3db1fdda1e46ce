// Renders a scene by every method and measures error, bytes and time.

#include "measure.h"

#include "lit_lightmap.h"
#include "pictures/frame_renderer.h"

#include "bake/reference/path_tracer.h"
#include "bake/reference/ray_renderer.h"
#include "prt/bake/bake.h"
#include "prt/compress/search.h"
#include "prt/fit/suns.h"
#include "prt/gl/gl_renderer.h"
#include "prt/render/tone_map.h"
#include "runtime/core/support/stopwatch.h"
#include "runtime/render/lightmap_lookup.h"

#include <epoxy/gl.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace comparison {
namespace {

using viewer::PictureKind;

constexpr int kOrders[] = {3, 4, 5, 6};
constexpr double kBytes[] = {5, 8, 12, 16};
/// Candidate radii of SSAO, relative to the scene's radius; the best one is used.
constexpr float kSsaoRadii[] = {0.02f, 0.05f, 0.1f, 0.2f, 0.4f};

class SceneMeasurement {
public:
    SceneMeasurement(const std::filesystem::path& path, const std::vector<Sky>& skies, const Options& options,
                     const prt::GlContext& context, const std::function<void(const std::string&)>& say)
        : skies_(skies), options_(options), context_(context), say_(say),
          model_(viewer::load_model(path).model), gpu_(model_) {
        result_.name = path.stem().string();
        result_.vertices = model_->scene.receivers();
        result_.triangles = model_->scene.triangles();
        view_.camera = prt::automatic_camera(
            model_->scene, static_cast<float>(options.width) / static_cast<float>(options.height), 0.61f);
        settings_.textured = settings_.background = false;
        renderer_.resize({options.width, options.height, 1});
        result_.exposure = prt::automatic_exposure(skies.front().light);
    }

    SceneResult run() {
        for (const Sky& sky : skies_)
            trace_reference(sky);
        result_.reference = prt::mean_of(references_[0]);
        add_row("unshadowed irradiance", PictureKind::unshadowed, 0);
        add_ssao("SSAO, from depth", PictureKind::ssao);
        add_ssao("SSAO, with normals", PictureKind::ssao_normals);
        say_("ambient occlusion");
        gpu_.set_occlusion(viewer::ambient_occlusion(*model_, {}));
        add_row("baked AO", PictureKind::baked_ao, 1); // eight bits
        const prt::Transfer split = add_transfer();
        add_separate_suns(split);
        add_lightmap();
        return std::move(result_);
    }

private:
    void trace_reference(const Sky& sky) {
        say_("reference under " + sky.name);
        const prt::DistantLight light(sky.lat_long);
        prt::PathTraceOptions trace;
        trace.camera = view_.camera;
        trace.width = options_.width;
        trace.height = options_.height;
        trace.textured = trace.background = trace.antialiased = false;
        prt::PathTracedPicture traced = prt::path_traced(*model_->trace, light, trace, 2 * options_.passes);
        result_.surfaces = std::move(traced.surfaces);
        result_.reference_noise.push_back(prt::noise_of(traced.halves, result_.surfaces));
        references_.push_back(std::move(traced.halves));
    }

    /// Error of a picture under sky i.
    prt::PictureError error_of(const prt::Image& picture, std::size_t i) const {
        prt::PictureError error = prt::picture_error(picture, references_[i], result_.surfaces);
        error.flip.clear();
        return error;
    }

    void set_light(const Sky& sky) { gpu_.set_light(prt::truncated(sky.light, light_order_)); }

    prt::Image draw(PictureKind kind) {
        renderer_.draw(0, kind, gpu_, settings_, view_, {0, options_.width});
        return renderer_.read(0);
    }

    std::vector<prt::PictureError> errors(PictureKind kind, prt::Image* first_picture) {
        std::vector<prt::PictureError> errors;
        for (std::size_t i = 0; i < skies_.size(); ++i) {
            set_light(skies_[i]);
            prt::Image picture = draw(kind);
            errors.push_back(error_of(picture, i));
            if (i == 0 && first_picture)
                *first_picture = std::move(picture);
        }
        return errors;
    }

    /// Milliseconds of one call, all its work on the GPU done.
    template <class Work>
    double milliseconds(Work&& work) {
        work();
        glFinish();
        const prt::Stopwatch stopwatch;
        int calls = 0;
        do {
            work();
            glFinish();
            ++calls;
        } while (stopwatch.seconds() < options_.frame_seconds);
        return 1e3 * stopwatch.seconds() / calls;
    }

    void add_row(std::string method, PictureKind kind, double bytes) {
        say_(method);
        Row row;
        row.method = std::move(method);
        row.bytes_per_vertex = bytes;
        row.errors = errors(kind, &row.picture);
        row.frame_milliseconds = milliseconds([&] {
            renderer_.draw(0, kind, gpu_, settings_, view_, {0, options_.width});
        });
        row.relight_milliseconds = milliseconds([&] { set_light(skies_.front()); });
        result_.rows.push_back(std::move(row));
    }

    void add_ssao(const std::string& method, PictureKind kind) {
        double best = 0;
        float best_radius = 0;
        for (const float radius : kSsaoRadii) {
            settings_.ssao.radius = radius;
            double sum = 0;
            for (const prt::PictureError& error : errors(kind, nullptr))
                sum += error.relative_l2;
            if (best_radius == 0 || sum < best) {
                best = sum;
                best_radius = radius;
            }
        }
        settings_.ssao.radius = best_radius;
        add_row(fmt::format("{} (radius {:g})", method, best_radius), kind, 0);
    }

    /// Bakes the transfer with separate terms.
    prt::Transfer add_transfer() {
        say_("bake");
        prt::BakeOptions bake_options;
        bake_options.order = kOrders[std::size(kOrders) - 1];
        bake_options.rays = options_.bake_rays;
        bake_options.bounces = prt::kEndlessBounces;
        bake_options.tracer.backend = prt::Backend::cpu;
        bake_options.repairs.bad_textures = prt::BadTextures::ignore;
        bake_options.lamps.mode = prt::LampMode::none; // references are lit by skies alone
        prt::Transfer split = prt::bake(model_->scene, bake_options).baked.transfer;
        const prt::Transfer raw = prt::as_combined(split); // all light is in one sky, including suns
        result_.channels = raw.layout.channels();
        for (const int order : kOrders) {
            const prt::Transfer transfer = viewer::truncated(raw, order);
            light_order_ = order;
            gpu_.set_raw(transfer);
            add_row(fmt::format("PRT, order {}", order), PictureKind::prt,
                    static_cast<double>(transfer.dimension()) * 2); // bytes as float16
        }
        gpu_.drop_raw(); // a light change then counts the constants alone
        for (const double bytes : kBytes) {
            say_(fmt::format("compressing to {:g} bytes", bytes));
            prt::SearchOptions search;
            search.budget.bytes_per_vertex = bytes;
            const prt::SearchResult found =
                prt::compress_within(raw, prt::SceneSurface(model_->scene).view(), search);
            gpu_.set_compressed(found.result.transfer);
            add_row(fmt::format("PRT, order 6, {:g} bytes", bytes), PictureKind::prt_compressed,
                    found.result.statistics.bytes_with_bases(result_.vertices));
        }
        return split;
    }

    enum class Shadows { map, rays };

    /// Draws the scene under `sky` without its sun, and adds the sun's light at each pixel.
    template <class Transfer>
    prt::Image drawn_with_sun(const Sky& sky, const Transfer& transfer, Shadows shadows) const {
        const prt::Lighting lighting{sky.rest, prt::as_light(sky.suns, sky.rest.order)};
        const std::vector<glm::vec3> radiance = prt::exit_radiance(transfer, lighting);
        prt::Picture picture =
            viewer::picture_of(*model_, radiance, view_.camera, options_.width, options_.height);
        picture.suns = sky.suns;
        picture.textured = false;
        return shadows == Shadows::map ? prt::render_gl(picture, context_)
                                       : prt::render_rays(picture, *model_->trace, {.sun_rays = 64});
    }

    template <class Transfer>
    void add_sun_row(std::string method, double bytes, const Transfer& transfer, Shadows shadows) {
        say_(method);
        Row row{.method = std::move(method), .bytes_per_vertex = bytes, .errors = {}, .picture = {}};
        for (std::size_t i = 0; i < skies_.size(); ++i) {
            prt::Image picture = drawn_with_sun(skies_[i], transfer, shadows);
            add_picture(i, std::move(picture), row);
        }
        result_.rows.push_back(std::move(row));
    }

    void add_separate_suns(const prt::Transfer& split) {
        add_sun_row("PRT, order 6, sun by rays", static_cast<double>(split.dimension()) * 2, split,
                    Shadows::rays);
        prt::SearchOptions search;
        search.budget.bytes_per_vertex = 8;
        const prt::SearchResult found =
            prt::compress_within(split, prt::SceneSurface(model_->scene).view(), search);
        const double bytes = found.result.statistics.bytes_with_bases(result_.vertices);
        add_sun_row("PRT, 8 bytes, sun by rays", bytes, found.result.transfer, Shadows::rays);
        add_sun_row("PRT, 8 bytes, sun by shadow map", bytes, found.result.transfer, Shadows::map);
    }

    void add_lightmap() {
        say_("lightmap");
        const LitLightmap lit = make_lightmap(model_->path, options_.lightmap_size,
                                              kOrders[std::size(kOrders) - 1], options_.bake_rays);
        Row whole{.method = "lightmap, 8 bytes per texel",
                  .bytes_per_vertex = lit.bytes_per_texel,
                  .errors = {},
                  .picture = {}};
        Row separate = whole;
        separate.method = "lightmap, 8 bytes, sun by rays";
        for (std::size_t i = 0; i < skies_.size(); ++i) {
            const Sky& sky = skies_[i];
            const prt::ClusteredTransfer& transfer = lit.lightmap.compressed.transfer;
            const prt::Light all = prt::truncated(sky.light, sky.rest.order);
            add_picture(i, drawn_by(lit, prt::exit_radiance(transfer, all), {}), whole);
            const prt::Lighting rest{sky.rest, prt::as_light(sky.suns, sky.rest.order)};
            add_picture(i, drawn_by(lit, prt::exit_radiance(transfer, rest), sky.suns), separate);
        }
        result_.rows.push_back(std::move(whole));
        result_.rows.push_back(std::move(separate));
    }

    /// `radiance` [texels], and suns at each pixel.
    prt::Image drawn_by(const LitLightmap& lit, const std::vector<glm::vec3>& radiance,
                        std::span<const prt::Sun> suns) const {
        prt::Picture picture =
            viewer::picture_of(*lit.model, {}, view_.camera, options_.width, options_.height);
        const std::vector<glm::vec3> at_vertices =
            prt::at_vertices(lit.model->scene, lit.lightmap.layout, radiance);
        picture.radiance = at_vertices;
        picture.in_shader.lightmaps = {.layout = &lit.lightmap.layout, .radiance = radiance};
        picture.suns = suns;
        picture.textured = false;
        return prt::render_rays(picture, *lit.model->trace, {.sun_rays = 64});
    }

    /// Adds the error of a picture under sky i.
    void add_picture(std::size_t i, prt::Image picture, Row& row) const {
        row.errors.push_back(error_of(picture, i));
        if (i == 0)
            row.picture = std::move(picture);
    }

    const std::vector<Sky>& skies_;
    const Options& options_;
    const prt::GlContext& context_;
    const std::function<void(const std::string&)>& say_;
    std::shared_ptr<const viewer::Model> model_;
    viewer::GpuModel gpu_;
    viewer::FrameRenderer renderer_;
    viewer::DrawSettings settings_;
    viewer::FrameView view_;
    int light_order_ = 6;
    std::vector<std::array<prt::Image, 2>> references_; ///< [skies]
    SceneResult result_;
};

} // namespace

Sky load_sky(const std::filesystem::path& path) {
    const prt::Environment environment = prt::load_environment(path).environment;
    constexpr int kOrder = kOrders[std::size(kOrders) - 1];
    const prt::SunSplit split = prt::find_suns(environment, {.order = kOrder, .count = 1});
    return {path.stem().string(), prt::resampled_lat_long(environment),
            prt::project(environment, prt::kMaxOrder), split.suns, prt::project(split.remainder, kOrder)};
}

SceneResult measure(const std::filesystem::path& scene, const std::vector<Sky>& skies, const Options& options,
                    const prt::GlContext& context, const std::function<void(const std::string&)>& say) {
    SceneResult result = SceneMeasurement(scene, skies, options, context, say).run();
    result.device = context.renderer();
    return result;
}

} // namespace comparison
