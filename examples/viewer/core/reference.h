#pragma once

// A path-traced picture that refines in the background.

#include "core/model.h"

#include "prt/path_tracer.h"

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace viewer {

class Reference {
public:
    ~Reference();

    /// What the picture is of; `version` tells lights, options and models apart.
    struct Subject {
        std::shared_ptr<const Model> model;
        std::function<prt::DistantLight()> light; ///< called in the background
        prt::PathTraceOptions options;
        std::uint64_t version = 0;
    };
    /// Starts anew where the subject is another: at once a coarse picture, then a fine one that refines.
    void show(Subject subject);
    void stop();

    struct Result {
        prt::Image image;
        std::vector<bool> surfaces; ///< which pixels show the scene
        int passes = 0;             ///< at full resolution; 0: coarse
    };
    /// The newest picture where there is one since the last call.
    std::optional<Result> take();
    int passes() const;

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
    static void trace(const Subject& subject, Shared& shared, const std::stop_token& stop);
    std::uint64_t version_ = 0;
    Job job_;
    std::vector<Job> retired_;
};

/// Noise of so many paths is below what the eye sees.
inline constexpr int kMostPasses = 4096;

} // namespace viewer
