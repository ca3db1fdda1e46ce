#pragma once

// Work beside the drawing: it posts what it finds, and the thread that draws takes it in between two frames.

#include "prt/support/progress.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace viewer {

/// One piece of work at a time. Starting another stops the first without waiting for it; nothing that it
/// posts afterwards counts.
class BackgroundWork {
public:
    /// What work sees of the outside.
    class Channel {
    public:
        /// Says what is done next, for the panel.
        void stage(std::string name);
        /// `finding` runs on the thread that calls `collect`.
        void post(std::function<void()> finding);
        prt::Progress progress();

    private:
        friend class BackgroundWork;
        std::mutex mutex_;
        std::string stage_;
        double share_ = 0;
        bool done_ = false;
        std::vector<std::function<void()>> findings_;
        std::stop_token stop_;
    };

    ~BackgroundWork();
    /// `failed` gets the message of a `prt::Error` that `work` throws, on the thread that collects.
    void start(std::function<void(Channel&)> work, std::function<void(const std::string&)> failed);
    void stop();
    /// Runs what was posted since the last call.
    void collect();

    bool busy() const;
    std::string stage() const;
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
