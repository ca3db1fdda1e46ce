#include "core/background_work.h"

#include <utility>

namespace viewer {

void BackgroundWork::Channel::enter(Stage stage, std::string label) {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    label_ = std::move(label);
    share_ = 0;
}

void BackgroundWork::Channel::post(Finding finding) {
    const std::lock_guard lock(mutex_);
    findings_.push_back(std::move(finding));
}

prt::Progress BackgroundWork::Channel::progress() {
    return {[this](double share) {
                const std::lock_guard lock(mutex_);
                share_ = share;
            },
            stop_};
}

BackgroundWork::~BackgroundWork() {
    retire();
}

void BackgroundWork::retire() {
    if (!job_.channel)
        return;
    job_.thread.request_stop();
    retired_.push_back(std::exchange(job_, {}));
}

void BackgroundWork::start(std::function<void(Channel&)> work) {
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

std::vector<Finding> BackgroundWork::collect() {
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

Stage BackgroundWork::stage() const {
    if (!job_.channel)
        return Stage::starting;
    const std::lock_guard lock(job_.channel->mutex_);
    return job_.channel->stage_;
}

std::string BackgroundWork::label() const {
    if (!job_.channel)
        return {};
    const std::lock_guard lock(job_.channel->mutex_);
    return job_.channel->label_;
}

double BackgroundWork::share() const {
    if (!job_.channel)
        return 0;
    const std::lock_guard lock(job_.channel->mutex_);
    return job_.channel->share_;
}

} // namespace viewer
