#pragma once

// A path-traced picture that refines in the background.

#include "core/light_rig.h"
#include "pictures/model.h"

#include "bake/reference/path_tracer.h"

#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace viewer {

class Reference {
public:
    ~Reference();

    /// Input of the picture.
    struct Subject {
        std::shared_ptr<const Model> model;
        prt::PathTraceOptions options;
        std::uint64_t light_version = 0;
        std::shared_ptr<const prt::Scene> moving = {}; ///< moving objects in the scene; null: none

        friend bool operator==(const Subject&, const Subject&) = default;
    };
    /// Restarts if the subject changes: first a coarse picture, then a full one that refines. `rig` must
    /// match the version of the subject's light.
    void show(const Subject& subject, const LightRig& rig);
    void stop();

    struct Result {
        prt::Image image;
        std::vector<bool> surfaces; ///< true for pixels that show the scene
    };
    /// Returns the newest picture, which at first is that of the previous subject; null if there is none yet.
    const Result* result();
    int passes() const; ///< number of passes at full resolution; 0: coarse

private:
    struct Shared {
        std::mutex mutex;
        std::optional<Result> result;
        int passes = 0;
        bool done = false;
    };
    struct Job {
        std::shared_ptr<Shared> shared;
        std::jthread thread;
    };
    static void trace(const Subject& subject, const LightRig& rig, Shared& shared,
                      const std::stop_token& stop);
    void retire();

    std::optional<Subject> subject_;
    std::optional<Result> result_;
    Job job_;
    std::vector<Job> retired_;
};

/// Maximum number of passes; its noise is below the visible threshold.
inline constexpr int kMaxPasses = 4096;

} // namespace viewer
