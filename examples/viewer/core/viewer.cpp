// Applies user requests and findings to the viewer.

#include "core/viewer.h"

#include "core/budget_work.h"

#include "prt/core/error.h"
#include "prt/shader/shader_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr std::size_t kMaxMessages = 6;
constexpr float kFieldOfView = 0.61f;

bool is_environment(const std::filesystem::path& path) {
    return path.extension() == ".hdr" || path.extension() == ".exr" || path.extension() == ".pic";
}

bool is_model(const std::filesystem::path& path) {
    return path.extension() == ".glb" || path.extension() == ".gltf";
}

/// Returns a free file name next to the model.
std::filesystem::path shipped_path(const std::filesystem::path& model) {
    for (int i = 1;; ++i) {
        const std::string number = i == 1 ? "" : fmt::format("-{}", i);
        auto path = model.parent_path() / fmt::format("{}.shipped{}.glb", model.stem().string(), number);
        if (!std::filesystem::exists(path))
            return path;
    }
}

} // namespace

Viewer::Viewer() {
    lights = lighting_.rig.settings();
    restore_gpu();
}

void Viewer::restore_gpu() {
    gpu_ = std::make_unique<Gpu>();
    if (document_.model())
        upload_models();
}

void Viewer::message(const std::string& text) {
    if (!messages_.empty() && messages_.back() == text)
        return;
    messages_.push_back(text);
    if (messages_.size() > kMaxMessages)
        messages_.pop_front();
}

void Viewer::reset_camera() {
    const float aspect = static_cast<float>(seen_.size.x) / static_cast<float>(std::max(1, seen_.size.y));
    if (document_.model())
        camera = OrbitCamera(prt::automatic_camera(document_.model()->scene, aspect, kFieldOfView));
}

// ---- user requests

void Viewer::open(const std::vector<std::filesystem::path>& paths) {
    std::vector<std::filesystem::path> models, environments;
    for (const std::filesystem::path& path : paths) {
        if (is_model(path))
            models.push_back(path);
        else if (is_environment(path))
            environments.push_back(path);
        else
            message(path.string() +
                    ": the file is neither a model (.glb, .gltf) nor an environment map (.hdr, .exr)");
    }
    if (!environments.empty())
        jobs_.read_environments(environments);
    if (models.empty())
        return;
    const bool scene_open = document_.model() || jobs_.busy(JobKind::model);
    if (models.size() == 1 && !scene_open)
        open_scenes(models);
    else
        jobs_.sort(models, scene_open);
}

void Viewer::open_scenes(const std::vector<std::filesystem::path>& paths) {
    statistics_.begin_opening();
    OpenModels before{document_.loaded, document_.beside};
    if (jobs_.baking()) // an unfinished bake restarts if the scene stays open
        before.first.raw = nullptr;
    jobs_.open(paths, before);
}

void Viewer::bake_anew() {
    if (can_bake())
        jobs_.bake(document_.loaded.model);
}

void Viewer::measure_budget() {
    if (!can_measure())
        return message(document_.loaded.of_texels()
                           ? kMeasuredOfVertices
                           : "the error over the surface needs a bake: open its file, or wait for the bake");
    gpu_->budget = lampless();
    jobs_.find_budget(document_, lighting_.rig, lampless());
}

void Viewer::save(std::filesystem::path output) {
    if (!can_save())
        return message("no compressed transfer is available yet");
    if (output.empty())
        output = shipped_path(document_.model()->path);
    jobs_.save(document_, output);
}

void Viewer::use_environment(std::size_t index) {
    lighting_.rig.set_environment(lighting_.environments[index]);
    lights.day = false;
    lights.environment_on = true;
}

void Viewer::recompress_where_asked() {
    compression.order = std::clamp(compression.order, 1,
                                   std::max(1, document_.raw() ? document_.raw_order() : compression.order));
    if (!document_.raw() || !document_.compressed() || compression == document_.compressed_as)
        return;
    if (!jobs_.may_compress())
        return; // wait for the running job first
    document_.compressed_as = compression;
    jobs_.compress(document_, compression);
}

void Viewer::update(double seconds) {
    if (settings.day_runs && lights.day)
        lights.time.hour = std::fmod(lights.time.hour + seconds, 24.0); // one hour per second
    for (const Finding& finding : jobs_.collect())
        try {
            std::visit([this](const auto& found) { take(found); }, finding);
        } catch (const prt::Error& error) { // the finding does not fit into GPU memory
            message(error.what());
        }
    lighting_.rig.set(lights);
    lighting_.set_lamps(settings.lit.lamps);
    recompress_where_asked();
    follow_moving(seconds);
}

// ---- findings

void Viewer::take(const OpenModels& models) {
    document_.open(models);
    stop_budget();
    settings.lit.lamps.each.clear();
    follow_lamps();
    compression = document_.compressed_as;
    seen_.hovered.reset();
    lighting_.meter = {};
    reset_camera();
    upload_models();
}

/// Lists the lamps of the current transfer; lamps that remain keep their strength.
void Viewer::follow_lamps() {
    std::vector<LampControl>& lamps = settings.lit.lamps.each;
    lamps = lamps_of(document_.layouts(), lamps);
}

std::unique_ptr<GpuModel> Viewer::uploaded(const LoadedModel& loaded) {
    auto model = std::make_unique<GpuModel>(loaded.model);
    if (loaded.lightmap.baked)
        model->set_raw(loaded.lightmap.baked);
    else if (loaded.raw)
        model->set_raw(*loaded.raw);
    if (loaded.instanced)
        model->set_instanced(loaded.instanced);
    const prt::ClusteredTransfer* compressed = loaded.compressed.get();
    if (loaded.lightmap.compressed)
        model->set_compressed(loaded.lightmap.compressed);
    else if (compressed &&
             compressed->bases.max_components() <= prt::max_vertex_components(compressed->bases))
        model->set_compressed(*compressed);
    else if (compressed)
        message("the compressed transfer has too many components for vertex attributes");
    return model;
}

GpuModel* Viewer::gpu_model(const Model* model) const {
    return model == document_.model()              ? gpu_->model.get()
           : model == document_.beside.model.get() ? gpu_->beside.get()
                                                   : nullptr;
}

GpuModel& Viewer::gpu_model(const SidePicture& picture) const {
    const bool beside = &document_.shown_by(picture) == &document_.beside;
    return beside && gpu_->beside ? *gpu_->beside : *gpu_->model;
}

void Viewer::upload_models() {
    upload_moving();
    gpu_->model.reset(); // memory may not suffice for two models
    gpu_->beside.reset();
    gpu_->model = uploaded(document_.loaded);
    if (document_.has_both())
        gpu_->beside = uploaded(document_.beside);
    if (document_.occlusion)
        gpu_->model->set_occlusion(*document_.occlusion);
    if (document_.budget)
        gpu_->model->set_numbers(PictureKind::surface_error, document_.budget->colors);
}

void Viewer::take(const Baked& baked) {
    document_.set(baked);
    follow_lamps();
    if (gpu_->model)
        gpu_->model->set_raw(*baked.transfer);
}

void Viewer::take(const Compressed& compressed) {
    if (compressed.model == document_.loaded.model && compression == document_.compressed_as)
        compression = compressed.how; // settings in the file of a newly opened model
    document_.set(compressed);
    follow_lamps();
    GpuModel* const model = gpu_model(compressed.model.get());
    if (model && compressed.lightmap)
        model->set_compressed(compressed.lightmap);
    else if (model)
        model->set_compressed(*compressed.transfer);
}

void Viewer::take(const Occlusion& occlusion) {
    document_.occlusion = occlusion;
    if (gpu_->model)
        gpu_->model->set_occlusion(*occlusion);
}

void Viewer::take(const OpenedEnvironment& file) {
    if (!file.environment)
        return message(file.why);
    lighting_.environments.push_back(file.environment);
    use_environment(lighting_.environments.size() - 1);
}

void Viewer::take(const NumberPictures& pictures) {
    if (GpuModel* const model = gpu_model(pictures.model.get()))
        for (const auto& [kind, colors] : pictures.colors)
            model->set_numbers(kind, colors);
}

void Viewer::take(const RepeatedBake& repeated) {
    if (repeated.of == document_.loaded.raw)
        document_.repeated = repeated;
}

void Viewer::take(const SurfaceBudget& budget) {
    if (budget.model != document_.loaded.model)
        return;
    document_.budget = budget;
    if (gpu_->model)
        gpu_->model->set_numbers(PictureKind::surface_error, budget.colors);
}

void Viewer::take(const Saved& saved) {
    message("saved " + std::filesystem::absolute(saved.path).string());
}

void Viewer::take(const Failure& failure) {
    if (failure.job == JobKind::model)
        statistics_.fail_opening();
    message(failure.why);
}

} // namespace viewer
