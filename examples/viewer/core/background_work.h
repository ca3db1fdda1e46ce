#pragma once

// Work beside the drawing: it posts what it finds, and the thread that draws takes it in between two frames.

#include "prt/support/progress.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace viewer {

enum class Stage { starting, reading, baking, compressing, occlusion, saving, measuring };

/// One piece of work at a time, which posts values of type `Finding`. Starting another stops the first
/// without waiting for it; nothing that it posts afterwards counts.
template <class Finding>
class BackgroundWork {
public:
    /// What work sees of the outside.
    class Channel {
    public:
        /// Says what is done next, to the panel in words.
        void enter(Stage stage, std::string label) {
            const std::lock_guard lock(mutex_);
            stage_ = stage;
            label_ = std::move(label);
            share_ = 0;
        }
        void post(Finding finding) {
            const std::lock_guard lock(mutex_);
            findings_.push_back(std::move(finding));
        }
        prt::Progress progress() {
            return {[this](double share) {
                        const std::lock_guard lock(mutex_);
                        share_ = share;
                    },
                    stop_};
        }

    private:
        friend BackgroundWork;
        std::mutex mutex_;
        Stage stage_ = Stage::starting;
        std::string label_;
        double share_ = 0;
        bool done_ = false;
        std::vector<Finding> findings_;
        std::stop_token stop_;
    };

    ~BackgroundWork() { retire(); }
    /// `work` throws nothing but `prt::Cancelled`.
    void start(std::function<void(Channel&)> work) {
        retire();
        auto channel = std::make_shared<Channel>();
        job_.channel = channel;
        job_.thread = std::jthread([channel, work = std::move(work)](std::stop_token stop) {
            channel->stop_ = std::move(stop);
            try {
                work(*channel);
            } catch (const prt::Cancelled&) {
                // whoever asked for it knows
            }
            const std::lock_guard lock(channel->mutex_);
            channel->done_ = true;
        });
    }
    /// Ends the work without waiting for it; what it posts afterwards does not count.
    void stop() { retire(); }
    /// Returns what was posted since the last call.
    std::vector<Finding> collect() {
        std::erase_if(retired_, [](const Job& job) {
            const std::lock_guard lock(job.channel->mutex_);
            return job.channel->done_;
        });
        std::vector<Finding> findings;
        if (!job_.channel)
            return findings;
        bool done = false;
        {
            const std::lock_guard lock(job_.channel->mutex_);
            findings.swap(job_.channel->findings_);
            done = job_.channel->done_;
        }
        if (done)
            job_ = {};
        return findings;
    }

    bool busy() const { return job_.channel != nullptr; }
    Stage stage() const { return read(&Channel::stage_); }
    std::string label() const { return read(&Channel::label_); }
    double share() const { return read(&Channel::share_); } ///< of the stage, 0..1

private:
    struct Job {
        std::shared_ptr<Channel> channel;
        std::jthread thread;
    };
    void retire() {
        if (!job_.channel)
            return;
        job_.thread.request_stop();
        retired_.push_back(std::exchange(job_, {}));
    }

    /// What the channel holds, or what a new one would.
    template <class T>
    T read(T Channel::*member) const {
        if (!job_.channel)
            return T();
        const std::lock_guard lock(job_.channel->mutex_);
        return (*job_.channel).*member;
    }

    Job job_;
    std::vector<Job> retired_; ///< asked to stop, not yet at an end
};

} // namespace viewer
