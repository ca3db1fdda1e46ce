#pragma once

// Runs work in a background thread. The work posts its findings; the drawing thread collects them between
// frames.

#include "prt/core/progress.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace viewer {

enum class Stage { starting, reading, baking, compressing, occlusion, saving, measuring };

/// Runs one job at a time, which posts values of type `Finding`. Starting another job stops the first without
/// waiting for it; its later posts are ignored.
template <class Finding>
class BackgroundWork {
public:
    /// Connects a job to the drawing thread: it reports progress and findings, and carries the request to
    /// stop.
    class Channel {
    public:
        /// Sets the current stage and its label for the panel, and resets the progress.
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
    /// Starts a job. `work` must throw no exception except `prt::Cancelled`.
    void start(std::function<void(Channel&)> work) {
        retire();
        auto channel = std::make_shared<Channel>();
        job_.channel = channel;
        job_.thread = std::jthread([channel, work = std::move(work)](std::stop_token stop) {
            channel->stop_ = std::move(stop);
            try {
                work(*channel);
            } catch (const prt::Cancelled&) {
                // The caller requested the stop, so nothing is reported.
            }
            const std::lock_guard lock(channel->mutex_);
            channel->done_ = true;
        });
    }
    /// Stops the job without waiting for it; its later posts are ignored.
    void stop() { retire(); }
    /// Returns the findings posted since the last call.
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
    double share() const { return read(&Channel::share_); } ///< fraction of the stage that is done, 0..1

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

    /// Returns a member of the current channel under its lock, or a default value if no job runs.
    template <class T>
    T read(T Channel::*member) const {
        if (!job_.channel)
            return T();
        const std::lock_guard lock(job_.channel->mutex_);
        return (*job_.channel).*member;
    }

    Job job_;
    std::vector<Job> retired_; ///< jobs that were stopped but have not ended yet
};

} // namespace viewer
