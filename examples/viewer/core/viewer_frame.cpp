// Draws a frame of the viewer.

#include "core/budget_work.h"
#include "core/viewer.h"
#include "gpu/lobe.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

void clear(std::uint32_t framebuffer, const glm::ivec2& size) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size.x, size.y);
    glClearColor(0.05f, 0.055f, 0.07f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

} // namespace

void Viewer::draw(std::uint32_t framebuffer, int width, int height) {
    seen_.size = {width, height};
    statistics_.begin_frame();
    gpu_->renderer.resize({.width = width, .height = height, .samples = settings.drawing.samples});
    follow_light();
    find_numbers();
    follow_budget();
    gpu_->moving.show(settings.drawing.moving);
    gpu_->moving.pose(document_.moving.pose());
    if (settings.drawing.moving.spheres)
        gpu_->moving.place(document_.moving.spheres());
    const FrameView view = frame_view();
    gpu_->frame.begin();
    if (!gpu_->model) {
        clear(framebuffer, seen_.size);
        gpu_->frame.end();
        return;
    }
    const SidePicture left = left_picture(settings), right = right_picture(settings);
    const std::array<SidePicture, 2> pictures = {SidePicture(shown(left).kind, left.receivers),
                                                 SidePicture(shown(right).kind, right.receivers)};
    draw_sides(pictures, view);
    Figures& figures = statistics_.figures;
    if (settings.difference)
        figures.difference = gpu_->renderer.difference();
    gpu_->renderer.composite(framebuffer, settings, view, {pictures[0].kind, pictures[1].kind},
                             figures.difference.mean);
    gpu_->frame.end();
    measure(pictures[1], view);
    seen_.hovered.reset();
    if (settings.lobe)
        draw_lobe(framebuffer, view);
    statistics_.end_opening();
}

void Viewer::follow_light() {
    if (gpu_->model && gpu_->lit != version()) {
        for (GpuModel* model : {gpu_->model.get(), gpu_->beside.get()})
            if (model)
                model->set_lighting(light().lighting, light().suns, lighting_.lamps());
        gpu_->moving.set_lighting(light().lighting, light().suns, lighting_.lamps());
        if (document_.compressed() || document_.loaded.instanced)
            statistics_.figures.milliseconds.constants = 1e3 * gpu_->model->seconds_constants();
        gpu_->lit = version();
    }
    const LightRig& rig = lighting_.rig;
    if (gpu_->background_version != rig.background_version()) {
        const prt::Image* image = rig.background();
        gpu_->background = image ? prt::make_background(*image) : prt::GlObject();
        gpu_->background_version = rig.background_version();
    }
}

/// Requests the colors of number pictures for the newest transfer and light; a background job computes them.
void Viewer::find_numbers() {
    const bool wanted = shows_numbers(settings.left) || shows_numbers(settings.right);
    const bool there = document_.compressed() || document_.beside.compressed;
    if (!wanted || !there || gpu_->numbers == version() || jobs_.busy(JobKind::numbers))
        return;
    gpu_->numbers = version();
    jobs_.find_numbers(document_, light().lighting, lighting_.lamps());
}

/// Measures the budget for its picture when transfer or light change, one at a time.
void Viewer::follow_budget() {
    const bool asked = gpu_->budget == lampless() || budget_is_current() || jobs_.busy(JobKind::budget);
    if (wants(PictureKind::surface_error) && can_measure() && !asked)
        measure_budget();
}

FrameView Viewer::frame_view() {
    FrameView view;
    view.camera = camera.camera();
    float exposure = 1;
    if (document_.model())
        exposure = lighting_.meter.exposure({.model = document_.model(),
                                             .camera = view.camera,
                                             .width = seen_.size.x,
                                             .height = seen_.size.y,
                                             .textured = settings.drawing.textured},
                                            {.loaded = document_.loaded,
                                             .lamps = lighting_.lamps(),
                                             .darkness = lighting_.rig.darkness(),
                                             .version = version()},
                                            [this] { return lighting_.light(document_.light_order()); });
    view.exposure = exposure * std::exp2(settings.exposure_stops);
    view.background = gpu_->background.name() != 0 ? &gpu_->background : nullptr;
    view.background_rotation = lights.rotation;
    view.moving = &gpu_->moving;
    return view;
}

/// Returns a note about light that is missing in an available picture.
std::string Viewer::left_out(const SidePicture& picture) const {
    const PictureKind kind = picture.kind;
    const bool transfer = kind == PictureKind::prt || kind == PictureKind::prt_compressed;
    if (!transfer && !shows_numbers(kind) && any_shines(settings.lit.lamps))
        return kind == PictureKind::reference ? "without lamps and emission" : "without lamps";
    if (kind == PictureKind::surface_error && !budget_is_current())
        return "measured with other light or transfer";
    if (kind != PictureKind::reference && gpu_model(picture).takes_suns_as_sky(kind))
        return "the transfer has no direct term: suns are part of the sky";
    return "";
}

std::string Viewer::never_shown(const SidePicture& wanted) const {
    if (!document_.model() || jobs_.busy(JobKind::model))
        return "";
    const LoadedModel& loaded = document_.shown_by(wanted);
    if (wanted.kind == PictureKind::surface_error && loaded.of_texels())
        return kMeasuredOfVertices;
    const bool needs_raw = wanted.kind == PictureKind::prt || wanted.kind == PictureKind::error ||
                           wanted.kind == PictureKind::seams || wanted.kind == PictureKind::surface_error;
    if (!needs_raw || loaded.raw)
        return "";
    return loaded.of_texels() ? "the file contains only a compressed lightmap; also open its bake"
                              : "the file contains only compressed transfer; bake again to see it";
}

Viewer::Shown Viewer::shown(const SidePicture& wanted) const {
    if (!gpu_->model)
        return {wanted.kind, ""};
    if (wanted.kind == PictureKind::reference || gpu_model(wanted).can_draw(wanted.kind))
        return {wanted.kind, left_out(wanted)};
    const std::string why = never_shown(wanted);
    return {PictureKind::unshadowed, why.empty() ? "not available yet" : why};
}

void Viewer::draw_sides(const std::array<SidePicture, 2>& pictures, const FrameView& view) {
    const LoadedModel* const lightmap = document_.lightmap();
    // the difference would also show the grid
    const bool grid = settings.drawing.texel_grid && lightmap && !settings.difference;

    const int width = seen_.size.x,
              split = static_cast<int>(std::lround(settings.split * static_cast<float>(width)));
    for (int side = 0; side < 2; ++side) {
        const int first = settings.difference || side == 0 ? 0 : split,
                  last = settings.difference || side == 1 ? width : split;
        const SidePicture& picture = pictures[static_cast<std::size_t>(side)];
        if (first >= last)
            continue;
        if (picture.kind == PictureKind::reference) {
            show_reference(side, view);
            continue;
        }
        gpu_->renderer.draw(side, picture.kind, gpu_model(picture), settings.drawing, view, {first, last});
        if (grid)
            gpu_->renderer.draw_texel_grid(side, picture.kind, *gpu_model(lightmap->model.get()),
                                           settings.drawing, view, {first, last});
    }
    if (!wants(PictureKind::reference))
        reference_.stop();
}

void Viewer::show_reference(int side, const FrameView& view) {
    reference_.show({.model = document_.loaded.model,
                     .options = {.camera = view.camera,
                                 .width = seen_.size.x,
                                 .height = seen_.size.y,
                                 .bounces = document_.loaded.record.bounces,
                                 .textured = settings.drawing.textured,
                                 .background = settings.drawing.background},
                     .light_version = lighting_.rig.version(),
                     .moving = document_.moving.surfaces(settings.drawing.moving)},
                    lighting_.rig);
    if (const Reference::Result* result = reference_.result())
        gpu_->renderer.show(side, result->image, result->surfaces);
}

/// Collects the figures of the frame just drawn.
void Viewer::measure(const SidePicture& right, const FrameView& view) {
    Figures& figures = statistics_.figures;
    figures.milliseconds.gpu = gpu_->frame.milliseconds();
    figures.triangles_drawn = gpu_model(right).drawn_triangles();
    if (statistics_.times_vertices() && settings.panels && right.kind != PictureKind::reference) {
        gpu_->vertices.begin();
        gpu_->renderer.draw_vertices_only(right.kind, gpu_model(right), settings.drawing, view);
        gpu_->vertices.end();
        figures.milliseconds.vertices = gpu_->vertices.milliseconds();
    }
    figures.reference_passes = reference_.passes();
    figures.receivers = document_.model()->scene.receivers();
    figures.triangles = document_.model()->scene.triangles();
    figures.transfer = document_.loaded.of_texels() ? TransferFigures() : figures_of(document_.loaded);
    const GpuInstances* instances = gpu_->model->instances();
    figures.instances = instances ? std::optional(instances->figures()) : std::nullopt;
    figures.lightmap.reset();
    if (const LoadedModel* lightmap = document_.lightmap())
        figures.lightmap = lightmap_figures_of(*lightmap);
}

/// Returns the picture on the side under the pointer.
SidePicture Viewer::under_pointer() const {
    const bool left = !settings.difference && seen_.pointer &&
                      seen_.pointer->x < settings.split * static_cast<float>(seen_.size.x);
    return left ? left_picture(settings) : right_picture(settings);
}

/// Draws the transfer of the receiver under the pointer as a lobe.
void Viewer::draw_lobe(std::uint32_t framebuffer, const FrameView& view) {
    if (seen_.pointer)
        seen_.hovered = find_hovered(document_.shown_by(under_pointer()), settings.right == PictureKind::prt,
                                     screen(), *seen_.pointer);
    const std::optional<Hovered>& hovered = seen_.hovered;
    if (!hovered || hovered->order == 0)
        return;
    const float radius = 0.2f * document_.model()->radius;
    prt::Bounds box = document_.model()->box;
    box.low -= glm::vec3(radius);
    box.high += glm::vec3(radius);
    const ColoredMesh lobe = make_lobe(hovered->order, hovered->vector, hovered->position, radius,
                                       glm::normalize(view.camera.position - hovered->position));
    const float aspect = static_cast<float>(seen_.size.x) / static_cast<float>(seen_.size.y);
    gpu_->meshes.draw(lobe, prt::view_projection(view.camera, box, aspect), framebuffer);
}

} // namespace viewer
