#include "core/viewer.h"

#include "core/lobe.h"

#include "prt/support/error.h"
#include "prt/tone_map.h"

#include <epoxy/gl.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr std::size_t kMostMessages = 6;

} // namespace

Viewer::Viewer() {
    lights = rig_.settings();
    restore_gpu();
}

void Viewer::release_gpu() {
    gpu_.reset();
}

void Viewer::restore_gpu() {
    gpu_ = std::make_unique<Gpu>();
    if (model_)
        upload_model();
}

void Viewer::message(const std::string& text) {
    if (!messages_.empty() && messages_.back() == text)
        return;
    messages_.push_back(text);
    if (messages_.size() > kMostMessages)
        messages_.pop_front();
}

void Viewer::take(const LoadedModel& loaded) {
    model_ = loaded.model;
    raw_ = loaded.raw;
    compressed_ = loaded.compressed;
    occlusion_ = nullptr;
    record_ = loaded.record;
    if (!loaded.raw && !loaded.compressed)
        record_.bounces = kBakeBounces;
    if (compressed_) {
        const prt::ClusteredBases& bases = compressed_->bases;
        compression = {bases.order, static_cast<int>(bases.clusters()), bases.max_components()};
    } else {
        compression = {raw_ ? raw_->order : kBakeOrder, 256, 4};
    }
    compressed_how_ = compression;
    ++transfer_version_;
    hovered_.reset();
    exposure_meter_ = {};
    reset_camera();
    upload_model();
}

void Viewer::reset_camera() {
    const float aspect = static_cast<float>(width_) / static_cast<float>(std::max(1, height_));
    if (model_)
        camera = OrbitCamera(prt::automatic_camera(model_->scene, aspect, 0.61f));
}

void Viewer::upload_model() {
    gpu_->model.reset(); // there may not be room for two
    gpu_->model = std::make_unique<GpuModel>(model_);
    if (raw_)
        gpu_->model->set_raw(*raw_);
    if (compressed_ && compressed_->bases.max_components() <= prt::kMostVertexComponents)
        gpu_->model->set_compressed(*compressed_);
    else if (compressed_)
        message("the compressed transfer has more components than a vertex has attributes");
    if (occlusion_)
        gpu_->model->set_occlusion(*occlusion_);
    gpu_->light_version = 0; // again for this model
    numbers_version_ = 0;
}

// ---- work in the background

void Viewer::bake_anew() {
    if (!model_)
        return;
    work_.start(
        [this, model = model_](BackgroundWork::Channel& channel) {
            complete(channel, {model, {}, {}, {}});
        },
        [this](const std::string& why) { message(why); });
}

/// Runs in the background: what `loaded` lacks is computed and posted.
void Viewer::complete(BackgroundWork::Channel& channel, LoadedModel loaded) {
    if (!loaded.raw && !loaded.compressed)
        loaded.raw =
            bake_in_stages(channel, *loaded.model, [this](const Baked& baked) { set_baked(baked); }).transfer;
    if (!loaded.compressed) {
        const CompressionSettings how{loaded.raw->order, 256, 4};
        const auto compressed = compress_as(channel, *loaded.model, *loaded.raw, how);
        channel.post([this, compressed, how] { set_compressed(compressed, how); });
    }
    find_occlusion(channel, *loaded.model);
}

void Viewer::find_occlusion(BackgroundWork::Channel& channel, const Model& model) {
    channel.stage("ambient occlusion");
    auto occlusion = std::make_shared<const std::vector<float>>(ambient_occlusion(model, channel.progress()));
    channel.post([this, occlusion] { set_occlusion(occlusion); });
}

void Viewer::recompress_where_asked() {
    compression.order = std::clamp(compression.order, 1, std::max(1, raw_ ? raw_->order : compression.order));
    if (!raw_ || !compressed_ || compression == compressed_how_)
        return;
    if (work_.busy() && work_.stage() != "compressing")
        return;                    // first what is under way
    compressed_how_ = compression; // asked for
    work_.start(
        [this, model = model_, raw = raw_, how = compression,
         occlusion = occlusion_](BackgroundWork::Channel& channel) {
            const auto compressed = compress_as(channel, *model, *raw, how);
            channel.post([this, compressed, how] { set_compressed(compressed, how); });
            if (!occlusion)
                find_occlusion(channel, *model);
        },
        [this](const std::string& why) { message(why); });
}

void Viewer::set_baked(const Baked& baked) {
    raw_ = baked.transfer;
    record_ = baked.record;
    ++transfer_version_;
    if (gpu_->model)
        gpu_->model->set_raw(*raw_);
    gpu_->light_version = 0;
}

void Viewer::set_compressed(std::shared_ptr<const prt::ClusteredTransfer> transfer,
                            const CompressionSettings& how) {
    compressed_ = std::move(transfer);
    if (!(compression == how) && compressed_how_ == compression)
        compression = how; // the file's own, when a model was opened
    compressed_how_ = how;
    ++transfer_version_;
    if (gpu_->model)
        gpu_->model->set_compressed(*compressed_);
    gpu_->light_version = 0;
}

void Viewer::set_occlusion(std::shared_ptr<const std::vector<float>> occlusion) {
    occlusion_ = std::move(occlusion);
    if (gpu_->model)
        gpu_->model->set_occlusion(*occlusion_);
}

// ---- frames

int Viewer::light_order() const {
    int order = 3;
    if (raw_)
        order = std::max(order, raw_->order);
    if (compressed_)
        order = std::max(order, compressed_->bases.order);
    return order;
}

/// Formed once for all that want it.
const prt::Light& Viewer::light() {
    if (light_version_ != rig_.version() || light_.order != light_order())
        light_ = rig_.light(light_order());
    light_version_ = rig_.version();
    return light_;
}

void Viewer::update(double seconds) {
    if (day_runs && lights.day)
        lights.time.hour = std::fmod(lights.time.hour + seconds, 24.0); // an hour a second
    for (BackgroundWork* work : {&environment_work_, &work_, &numbers_work_, &save_work_})
        try {
            work->collect();
        } catch (const prt::Error& error) { // what was found does not fit the GPU
            message(error.what());
        }
    rig_.set(lights);
    recompress_where_asked();
}

void Viewer::follow_light() {
    if (gpu_->light_version != rig_.version() && gpu_->model) {
        gpu_->model->set_light(light());
        if (compressed_)
            figures_.constants_milliseconds = 1e3 * gpu_->model->seconds_constants();
        gpu_->light_version = rig_.version();
    }
    if (gpu_->background_version != rig_.background_version()) {
        const prt::Image* image = rig_.background();
        gpu_->background = image ? prt::make_background(*image) : prt::GlObject();
        gpu_->background_version = rig_.background_version();
    }
}

bool Viewer::wants(PictureKind kind) const {
    return settings.left == kind || settings.right == kind;
}

/// Colours for numbers, of the newest transfer and light. What takes the CPU goes to the background.
void Viewer::find_numbers() {
    const std::uint64_t version = (transfer_version_ << 32) + rig_.version();
    const bool wanted = wants(PictureKind::clusters) || wants(PictureKind::components) ||
                        wants(PictureKind::error) || wants(PictureKind::seams);
    if (!wanted || !compressed_ || version == numbers_version_ || numbers_work_.busy())
        return;
    numbers_version_ = version;
    numbers_work_.start(
        [this, model = model_, raw = raw_, compressed = compressed_,
         light = light()](BackgroundWork::Channel& channel) {
            const auto pictures = number_pictures(*model, raw.get(), *compressed, light);
            channel.post([this, model, pictures] {
                if (model == model_ && gpu_->model)
                    for (const auto& [kind, colors] : pictures)
                        gpu_->model->set_numbers(kind, colors);
            });
        },
        [this](const std::string& why) { message(why); });
}

FrameView Viewer::frame_view() {
    FrameView view;
    view.camera = camera.camera();
    float exposure = 1;
    if (model_)
        exposure = exposure_meter_.exposure({.model = model_.get(),
                                             .camera = view.camera,
                                             .width = width_,
                                             .height = height_,
                                             .textured = settings.textured,
                                             .raw = raw_.get(),
                                             .compressed = compressed_.get(),
                                             .radiance_version = (transfer_version_ << 32) + rig_.version()},
                                            [this] { return light(); });
    automatic_stops_ = std::log2(exposure);
    view.exposure = exposure * std::exp2(settings.exposure_stops);
    view.background = gpu_->background.name() != 0 ? &gpu_->background : nullptr;
    view.background_rotation = lights.rotation;
    return view;
}

Screen Viewer::screen() const {
    return {camera.camera(), {static_cast<float>(width_), static_cast<float>(height_)}};
}

Viewer::Shown Viewer::shown(PictureKind wanted) const {
    if (wanted == PictureKind::reference || !gpu_->model || gpu_->model->can_draw(wanted))
        return {wanted, ""};
    std::string why = "not there yet";
    const bool needs_raw =
        wanted == PictureKind::prt || wanted == PictureKind::error || wanted == PictureKind::seams;
    if (needs_raw && !raw_ && !work_.busy())
        why = "the file holds compressed transfer only; bake to see it";
    return {PictureKind::unshadowed, why};
}

void Viewer::draw(std::uint32_t framebuffer, int width, int height) {
    width_ = width;
    height_ = height;
    const double milliseconds = 1e3 * since_frame_.seconds();
    figures_.frame_milliseconds += 0.1 * (milliseconds - figures_.frame_milliseconds);
    figures_.longest_milliseconds = std::max(figures_.longest_milliseconds, milliseconds);
    since_frame_ = {};
    gpu_->renderer.resize(width, height, settings.samples);
    follow_light();
    find_numbers();
    const FrameView view = frame_view();
    gpu_->frame.begin();
    if (!gpu_->model) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, width, height);
        glClearColor(0.05f, 0.055f, 0.07f, 1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        gpu_->frame.end();
        return;
    }
    const std::array<PictureKind, 2> kinds = {shown(settings.left).kind, shown(settings.right).kind};
    const int split = static_cast<int>(std::lround(settings.split * static_cast<float>(width)));
    for (int side = 0; side < 2; ++side) {
        const int first = settings.difference || side == 0 ? 0 : split,
                  last = settings.difference || side == 1 ? width : split;
        const PictureKind kind = kinds[static_cast<std::size_t>(side)];
        if (first >= last)
            continue;
        if (kind == PictureKind::reference)
            show_reference(side, width, height, view);
        else
            gpu_->renderer.draw(side, kind, *gpu_->model, settings, view, first, last);
    }
    if (!wants(PictureKind::reference)) {
        reference_.stop();
        reference_subject_.clear();
        reference_result_.reset();
    }
    if (settings.difference) {
        figures_.difference = gpu_->renderer.difference();
        mean_radiance_ = figures_.difference.mean;
    }
    gpu_->renderer.composite(framebuffer, settings, view, kinds, mean_radiance_);
    gpu_->frame.end();
    figures_.gpu_milliseconds = gpu_->frame.milliseconds();
    figures_.triangles_drawn = gpu_->model->drawn_triangles();
    if (settings.panels && frames_ % 16 == 0 && kinds[1] != PictureKind::reference) {
        gpu_->vertices.begin();
        gpu_->renderer.draw_vertices_only(kinds[1], *gpu_->model, settings, view);
        gpu_->vertices.end();
        figures_.vertex_milliseconds = gpu_->vertices.milliseconds();
    }
    pick();
    if (settings.lobe && hovered_)
        draw_lobe(framebuffer, width, height, view);
    if (opening_) {
        glFinish();
        figures_.open_milliseconds = 1e3 * opening_->seconds();
        opening_.reset();
    }
    figures_.reference_passes = reference_.passes();
    figures_.receivers = model_->scene.receivers();
    figures_.triangles = model_->scene.triangles();
    figures_.raw_bytes = raw_ ? raw_->vectors.size() * sizeof(float) : 0;
    figures_.order = compressed_ ? compressed_->bases.order : raw_ ? raw_->order : 0;
    figures_.channels = compressed_ ? compressed_->bases.channels : raw_ ? raw_->channels : 0;
    if (compressed_) {
        const auto receivers = static_cast<double>(std::max<std::size_t>(1, figures_.receivers));
        figures_.bytes_per_vertex = static_cast<double>(prt::bytes_per_receiver(*compressed_));
        figures_.bytes_with_bases =
            figures_.bytes_per_vertex + static_cast<double>(prt::basis_bytes(compressed_->bases)) / receivers;
        figures_.clusters = static_cast<int>(compressed_->bases.clusters());
    }
    ++frames_;
}

void Viewer::show_reference(int side, int width, int height, const FrameView& view) {
    Reference::Subject subject;
    subject.model = model_;
    subject.options.camera = view.camera;
    subject.options.width = width;
    subject.options.height = height;
    subject.options.bounces = record_.bounces;
    subject.options.textured = settings.textured;
    subject.options.background = settings.background;
    const prt::Camera& c = view.camera;
    const std::string key = fmt::format(
        "{} {} {} {} {} {} {} {} {} {} {} {} {} {}", static_cast<const void*>(model_.get()), rig_.version(),
        width, height, record_.bounces, settings.textured, settings.background, c.position.x, c.position.y,
        c.position.z, c.target.x, c.target.y, c.target.z, c.vertical_field_of_view);
    if (key != reference_subject_) {
        reference_subject_ = key;
        subject.version = ++reference_version_;
        subject.light = [rig = rig_] { return rig.distant_light(); };
        reference_.show(std::move(subject));
    }
    if (auto result = reference_.take())
        reference_result_ = std::move(result);
    if (reference_result_)
        gpu_->renderer.show(side, reference_result_->image, reference_result_->surfaces);
}

void Viewer::pick() {
    hovered_.reset();
    if (settings.lobe && pointer_)
        hovered_ = find_hovered(*model_, raw_.get(), compressed_.get(), settings.right == PictureKind::prt,
                                screen(), *pointer_);
}

void Viewer::draw_lobe(std::uint32_t framebuffer, int width, int height, const FrameView& view) {
    if (hovered_->order == 0)
        return;
    const float radius = 0.2f * model_->radius;
    prt::Bounds box = model_->box;
    box.low -= glm::vec3(radius);
    box.high += glm::vec3(radius);
    const ColoredMesh lobe = make_lobe(hovered_->order, hovered_->vector, hovered_->position, radius,
                                       glm::normalize(view.camera.position - hovered_->position));
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    gpu_->meshes.draw(lobe, prt::view_projection(view.camera, box, aspect), framebuffer);
}

} // namespace viewer
