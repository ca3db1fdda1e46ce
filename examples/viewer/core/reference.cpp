// Path-traces the reference picture in a background thread.

#include "core/reference.h"

#include "pictures/joined_scene.h"

#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <utility>

namespace viewer {
namespace {

constexpr int kCoarser = 4; ///< The first picture is smaller by this factor along each axis.

std::vector<prt::Texture> textures_of(const Model& model, const prt::Scene& moving) {
    std::vector<prt::Texture> textures = model.trace->textures();
    for (prt::Texture& texture : prt::load_textures(moving, prt::BadTextures::ignore))
        textures.push_back(std::move(texture));
    return textures;
}

/// A model together with the moving objects in it.
struct WholeScene {
    WholeScene(const Model& model, const prt::Scene& moving)
        : scene(joined(model.scene, moving)), trace(scene, textures_of(model, moving)) {}
    prt::Scene scene;
    prt::TraceScene trace;
};

} // namespace

Reference::~Reference() {
    stop();
}

void Reference::retire() {
    if (!job_.shared)
        return;
    job_.thread.request_stop();
    retired_.push_back(std::exchange(job_, {}));
}

void Reference::stop() {
    retire();
    subject_.reset();
    result_.reset();
}

void Reference::show(const Subject& subject, const LightRig& rig) {
    if (subject == subject_)
        return;
    retire();
    subject_ = subject;
    auto shared = std::make_shared<Shared>();
    job_.shared = shared;
    job_.thread = std::jthread([shared, subject, rig](const std::stop_token& token) {
        try {
            trace(subject, rig, *shared, token);
        } catch (const prt::Cancelled&) {
            // another picture is requested
        }
        const std::lock_guard lock(shared->mutex);
        shared->done = true;
    });
}

void Reference::trace(const Subject& subject, const LightRig& rig, Shared& shared,
                      const std::stop_token& stop) {
    const std::shared_ptr<const WholeScene> whole =
        subject.moving ? std::make_shared<const WholeScene>(*subject.model, *subject.moving) : nullptr;
    const prt::TraceScene& scene = whole ? whole->trace : *subject.model->trace;
    // Leaves one thread for drawing.
    const int threads = std::max(1, prt::thread_count(0) - 1);
    const prt::DistantLight light = rig.distant_light();
    prt::PathTraceOptions coarse = subject.options;
    coarse.width = std::max(1, coarse.width / kCoarser);
    coarse.height = std::max(1, coarse.height / kCoarser);
    for (const prt::PathTraceOptions& options : {coarse, subject.options}) {
        const bool fine = options.width == subject.options.width;
        prt::PathTracer tracer(scene, light, options);
        const std::vector<bool> surfaces = tracer.surface_mask();
        for (int pass = 0; pass < (fine ? kMaxPasses : 4); ++pass) {
            tracer.add_pass(threads, stop);
            const std::lock_guard lock(shared.mutex);
            shared.result = Result{tracer.image(), surfaces};
            shared.passes = fine ? tracer.passes() : 0;
        }
    }
}

const Reference::Result* Reference::result() {
    std::erase_if(retired_, [](const Job& job) {
        const std::lock_guard lock(job.shared->mutex);
        return job.shared->done;
    });
    if (job_.shared) {
        const std::lock_guard lock(job_.shared->mutex);
        if (job_.shared->result)
            result_ = std::exchange(job_.shared->result, std::nullopt);
    }
    return result_ ? &*result_ : nullptr;
}

int Reference::passes() const {
    if (!job_.shared)
        return 0;
    const std::lock_guard lock(job_.shared->mutex);
    return job_.shared->passes;
}

} // namespace viewer
