#include "core/background_work.h"

#include "prt/support/error.h"

#include <algorithm>
#include <utility>

namespace viewer {

void BackgroundWork::Channel::stage(std::string name) {
    const std::lock_guard lock(mutex_);
    stage_ = std::move(name);
    share_ = 0;
}

void BackgroundWork::Channel::post(std::function<void()> finding) {
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

void BackgroundWork::start(std::function<void(Channel&)> work,
                           std::function<void(const std::string&)> failed) {
    retire();
    auto channel = std::make_shared<Channel>();
    job_.channel = channel;
    job_.thread =
        std::jthread([channel, work = std::move(work), failed = std::move(failed)](std::stop_token stop) {
            channel->stop_ = std::move(stop);
            try {
                work(*channel);
            } catch (const prt::Cancelled&) {
                // whoever asked for it knows
            } catch (const std::exception& error) { // also std::bad_alloc of a file that is too large
                channel->post([failed, message = std::string(error.what())] { failed(message); });
            }
            const std::lock_guard lock(channel->mutex_);
            channel->done_ = true;
        });
}

void BackgroundWork::stop() {
    retire();
}

void BackgroundWork::collect() {
    std::erase_if(retired_, [](const Job& job) {
        const std::lock_guard lock(job.channel->mutex_);
        return job.channel->done_;
    });
    if (!job_.channel)
        return;
    std::vector<std::function<void()>> findings;
    bool done = false;
    {
        const std::lock_guard lock(job_.channel->mutex_);
        findings.swap(job_.channel->findings_);
        done = job_.channel->done_;
    }
    if (done)
        job_ = {};
    for (const auto& finding : findings)
        finding(); // may start other work
}

bool BackgroundWork::busy() const {
    return job_.channel != nullptr;
}

std::string BackgroundWork::stage() const {
    if (!job_.channel)
        return {};
    const std::lock_guard lock(job_.channel->mutex_);
    return job_.channel->stage_;
}

double BackgroundWork::share() const {
    if (!job_.channel)
        return 0;
    const std::lock_guard lock(job_.channel->mutex_);
    return job_.channel->share_;
}

} // namespace viewer
