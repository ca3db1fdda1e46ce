// Handles moving objects in the viewer.

#include "core/viewer.h"

#include "prt/core/error.h"

namespace viewer {

void Viewer::open_figure(const std::filesystem::path& path) {
    jobs_.read_figure(path);
}

void Viewer::choose_figure(const FigureChoice& choice) {
    if (!document_.moving.figure() || !document_.model())
        throw prt::Error("no figure is open");
    document_.moving.choose(choice, document_.loaded.model);
}

void Viewer::walk_figure(double seconds) {
    document_.moving.advance(seconds, static_cast<double>(settings.drawing.moving.speed));
}

void Viewer::take(const SortedFiles& sorted) {
    if (!sorted.scenes.empty())
        open_scenes(sorted.scenes);
}

void Viewer::take(const FigureFile& file) {
    document_.moving.set_figure(file);
    if (document_.model())
        document_.moving.choose({}, document_.loaded.model);
    gpu_->moving.set_figure(document_.moving.figure(), document_.moving.lobes().get());
}

void Viewer::take(const FoundOccluders& found) {
    document_.moving.set_occluders(found);
    gpu_->moving.set_occluders(document_.moving.occluders());
}

void Viewer::take(const FoundVolume& found) {
    if (found.model != document_.loaded.model)
        return;
    document_.moving.set_volume(found);
    follow_lamps();
    gpu_->moving.set_volume(found.volume);
    gpu_->lit = {}; // the new volume may need more bands
}

void Viewer::upload_moving() {
    gpu_->moving.set_figure(document_.moving.figure(), document_.moving.lobes().get());
    gpu_->moving.set_occluders(document_.moving.occluders());
    gpu_->moving.set_volume(document_.moving.volume().volume);
    gpu_->lit = {};
}

/// Moves the figure, unless the path tracer shows it in its current pose. Requests a volume once the model
/// job is idle if an object needs it.
void Viewer::follow_moving(double seconds) {
    const MovingSettings& shown = settings.drawing.moving;
    Moving& moving = document_.moving;
    if (shown.walks && !wants(PictureKind::reference))
        moving.advance(seconds, static_cast<double>(shown.speed));
    const bool lit = (shown.figure && moving.figure()) || shown.spheres || shown.probes;
    if (lit && document_.model() && !jobs_.busy(JobKind::model) && moving.ask_for_volume())
        jobs_.find_volume(document_.loaded.model);
}

} // namespace viewer
