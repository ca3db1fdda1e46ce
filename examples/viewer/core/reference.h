#pragma once

// A path-traced picture that refines in the background.

#include "core/light_rig.h"
#include "pictures/model.h"

#include "prt/path_tracer.h"

#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace viewer {

class Reference {
public:
    ~Reference();

    /// What the picture is of.
    struct Subject {
        std::shared_ptr<const Model> model;
        prt::PathTraceOptions options;
        std::uint64_t light_version = 0;
        std::shared_ptr<const prt::Scene> moving = {}; ///< that stands in it; null: nothing

        friend bool operator==(const Subject&, const Subject&) = default;
    };
    /// Starts anew where the subject is another: at once a coarse picture, then a fine one that refines.
    /// `rig` is lit as its version says.
    void show(const Subject& subject, const LightRig& rig);
    void stop();

    struct Result {
        prt::Image image;
        std::vector<bool> surfaces; ///< which pixels show the scene
    };
    /// The newest picture, at first that of the last subject; null: none yet.
    const Result* result();
    int passes() const; ///< at full resolution; 0: coarse

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

/// Noise of so many paths is below what the eye sees.
inline constexpr int kMostPasses = 4096;

} // namespace viewer
