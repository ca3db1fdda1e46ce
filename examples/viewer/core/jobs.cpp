// Starts the background jobs and posts their findings.

#include "core/jobs.h"

#include "core/budget_work.h"
#include "core/moving_work.h"
#include "core/transfer_work.h"

#include "prt/core/error.h"

#include <algorithm>
#include <iterator>

namespace viewer {
namespace {

void find_occlusion(Channel& channel, const Model& model) {
    channel.enter(Stage::occlusion, "ambient occlusion");
    channel.post(std::make_shared<const std::vector<float>>(ambient_occlusion(model, channel.progress())));
}

/// Computes and posts the results that `open` lacks.
void complete(Channel& channel, OpenModels open) {
    LoadedModel& first = open.first;
    if (!first.has_transfer())
        first.raw = bake_in_stages(channel, *first.model).transfer;
    for (const LoadedModel* loaded : {&open.first, &open.beside})
        if (loaded->model && !loaded->compressed && !loaded->instanced)
            channel.post(compress_as(channel, *loaded, {.order = loaded->raw->layout.order}));
    find_occlusion(channel, *first.model);
}

OpenedEnvironment read_environment(const std::filesystem::path& path) {
    try {
        return {path, std::make_shared<const LoadedEnvironment>(load_environment(path.string())), ""};
    } catch (const prt::Error& error) {
        return {path, nullptr, error.what()}; // one bad file does not stop the others
    }
}

} // namespace

void Jobs::start(JobKind kind, std::function<void(Channel&)> work) {
    works_[static_cast<std::size_t>(kind)].start([kind, work = std::move(work)](Channel& channel) {
        try {
            work(channel);
        } catch (const prt::Cancelled&) {
            throw;
        } catch (const std::exception& error) { // also std::bad_alloc of a file that is too large
            channel.post(Failure{kind, error.what()});
        }
    });
}

void Jobs::open(const std::vector<std::filesystem::path>& paths, const OpenModels& open) {
    start(JobKind::model, [paths, open](Channel& channel) {
        channel.enter(Stage::reading, "reading " + paths.front().filename().string());
        const OpenModels models = load_together(paths, open);
        channel.post(models);
        complete(channel, models);
    });
}

void Jobs::bake(std::shared_ptr<const Model> model) {
    start(JobKind::model, [model = std::move(model)](Channel& channel) {
        OpenModels bare;
        bare.first.model = model;
        complete(channel, std::move(bare));
    });
}

void Jobs::compress(const Document& document, const CompressionSettings& how) {
    start(JobKind::model,
          [loaded = document.loaded, how, with_occlusion = !document.occlusion](Channel& channel) {
              channel.post(compress_as(channel, loaded, how));
              if (with_occlusion)
                  find_occlusion(channel, *loaded.model);
          });
}

void Jobs::sort(const std::vector<std::filesystem::path>& paths, bool scene_open) {
    start(JobKind::figure, [paths, scene_open](Channel& channel) {
        channel.enter(Stage::reading, "reading " + paths.front().filename().string());
        const SortedFiles sorted = sort_files(paths, scene_open);
        channel.post(sorted);
        if (!sorted.figures.empty())
            find_figure(channel, sorted.figures.back());
    });
}

void Jobs::read_figure(const std::filesystem::path& path) {
    start(JobKind::figure, [path](Channel& channel) {
        channel.enter(Stage::reading, "reading " + path.filename().string());
        find_figure(channel, path);
    });
}

void Jobs::find_volume(std::shared_ptr<const Model> model) {
    start(JobKind::volume,
          [model = std::move(model)](Channel& channel) { viewer::find_volume(channel, model); });
}

void Jobs::read_environments(const std::vector<std::filesystem::path>& paths) {
    environments_to_read_.insert(environments_to_read_.end(), paths.begin(), paths.end());
    start(JobKind::environments, [all = environments_to_read_](Channel& channel) {
        for (const std::filesystem::path& path : all)
            channel.post(read_environment(path));
    });
}

void Jobs::find_numbers(const Document& document, const prt::Lighting& lighting, const LampSettings& lamps) {
    start(JobKind::numbers,
          [models = OpenModels{document.loaded, document.beside}, lighting, lamps](Channel& channel) {
              for (const LoadedModel* loaded : {&models.first, &models.beside})
                  if (loaded->compressed)
                      channel.post(NumberPictures{loaded->model, number_pictures(*loaded, lighting, lamps)});
          });
}

void Jobs::find_budget(const Document& document, const LightRig& rig, const RadianceVersion& version) {
    BudgetSubject subject{document.loaded, nullptr, rig, document.light_order(), version};
    if (document.repeated.of == document.loaded.raw)
        subject.repeated = document.repeated.transfer;
    start(JobKind::budget,
          [subject = std::move(subject)](Channel& channel) { viewer::find_budget(channel, subject); });
}

void Jobs::save(const Document& document, const std::filesystem::path& output) {
    start(JobKind::saving, [loaded = document.loaded, output](Channel& channel) {
        channel.enter(Stage::saving, "saving " + output.filename().string());
        save_compressed(loaded, output);
        channel.post(Saved{output});
    });
}

std::vector<Finding> Jobs::collect() {
    std::vector<Finding> all;
    for (const JobKind kind : {JobKind::environments, JobKind::model, JobKind::numbers, JobKind::saving,
                               JobKind::budget, JobKind::figure, JobKind::volume})
        std::ranges::move(works_[static_cast<std::size_t>(kind)].collect(), std::back_inserter(all));
    for (const Finding& finding : all)
        if (const auto* read = std::get_if<OpenedEnvironment>(&finding))
            std::erase(environments_to_read_, read->path);
    return all;
}

bool Jobs::busy() const {
    return busy(JobKind::model) || busy(JobKind::environments) || busy(JobKind::saving) ||
           busy(JobKind::figure) || busy(JobKind::volume);
}

bool Jobs::may_compress() const {
    return !busy(JobKind::model) || work(JobKind::model).stage() == Stage::compressing;
}

} // namespace viewer
