// Connects long functions to a Python caller.

#include "python/src/call.h"

#include <atomic>
#include <chrono>
#include <csignal>

namespace prt::python {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // only lock-free atomics are safe in a signal handler
struct sigaction previous_action = {};                 ///< Python's, valid while a watch is installed

constexpr auto kPoll = std::chrono::milliseconds(20);

void on_interrupt(int signal) {
    interrupted = true;
    if (previous_action.sa_handler != SIG_DFL && previous_action.sa_handler != SIG_IGN)
        previous_action.sa_handler(signal);
}

bool is_main_thread() {
    const py::module_ threading = py::module_::import("threading");
    return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

} // namespace

InterruptWatch::InterruptWatch() {
    struct sigaction current = {};
    if (!is_main_thread() || sigaction(SIGINT, nullptr, &current) != 0 ||
        current.sa_handler == on_interrupt || current.sa_handler == SIG_DFL || current.sa_handler == SIG_IGN)
        return;
    previous_action = current;
    interrupted = false;
    struct sigaction action = current;
    action.sa_handler = on_interrupt;
    installed_ = sigaction(SIGINT, &action, nullptr) == 0;
    watcher_ = std::jthread([this](const std::stop_token& finished) {
        while (!finished.stop_requested() && !interrupted)
            std::this_thread::sleep_for(kPoll);
        if (interrupted)
            stop_.request_stop();
    });
}

InterruptWatch::~InterruptWatch() {
    if (installed_)
        sigaction(SIGINT, &previous_action, nullptr);
}

void Call::raise_interrupt() {
    if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
}

void Call::report(const std::string& title, double fraction) {
    const py::gil_scoped_acquire acquire;
    raise_interrupt();
    if (!progress_.is_none())
        progress_(title, fraction);
}

Progress Call::progress(const std::string& title) {
    Progress progress{{}, stop_};
    if (progress_.is_none())
        return progress;
    progress.report = [this, title, last = -1.0](double fraction) mutable {
        if (fraction < 1 && fraction - last < 0.002)
            return;
        last = fraction;
        report(title, fraction);
    };
    return progress;
}

pipeline::Host Call::host() {
    pipeline::Host host;
    host.stages = [this](std::string_view title) { return pipeline::Stage{progress(std::string(title))}; };
    host.write = [this](const pipeline::Path& path, std::span<const std::byte> bytes) {
        if (!path.empty())
            files_[path].assign(bytes.begin(), bytes.end());
        return bytes.size();
    };
    host.notify = [this](const std::string& file, const std::vector<std::string>& notices) {
        for (const std::string& notice : notices)
            notices_.push_back(file + ": " + notice);
    };
    return host;
}

} // namespace prt::python
