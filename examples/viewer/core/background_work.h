#pragma once

// Work beside the drawing: it posts what it finds, and the thread that draws takes it in between two frames.

#include "core/findings.h"

#include "prt/support/progress.h"

#include <functional>
#include <mutex>
#include <thread>

namespace viewer {

enum class Stage { starting, reading, baking, compressing, occlusion, saving };

/// One piece of work at a time. Starting another stops the first without waiting for it; nothing that it
/// posts afterwards counts.
class BackgroundWork {
public:
    /// What work sees of the outside.
    class Channel {
    public:
        /// Says what is done next, to the panel in words.
        void enter(Stage stage, std::string label);
        void post(Finding finding);
        prt::Progress progress();

    private:
        friend class BackgroundWork;
        std::mutex mutex_;
        Stage stage_ = Stage::starting;
        std::string label_;
        double share_ = 0;
        bool done_ = false;
        std::vector<Finding> findings_;
        std::stop_token stop_;
    };

    ~BackgroundWork();
    /// `work` throws nothing but `prt::Cancelled`.
    void start(std::function<void(Channel&)> work);
    /// Returns what was posted since the last call.
    std::vector<Finding> collect();

    bool busy() const { return job_.channel != nullptr; }
    Stage stage() const;
    std::string label() const;
    double share() const; ///< of the stage, 0..1

private:
    struct Job {
        std::shared_ptr<Channel> channel;
        std::jthread thread;
    };
    void retire();
    Job job_;
    std::vector<Job> retired_; ///< asked to stop, not yet at an end
};

} // namespace viewer
