// Handles interrupts, progress and outputs of a run.

#include "cli/program/session.h"

#include "cli/program/terminal.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include <unistd.h>

namespace prt::cli {
namespace {

/// Set by the thread that receives the signal. Libraries start threads before main, so blocking signals here
/// would not prevent them from terminating the program.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // only lock-free atomics are safe in a signal handler

constexpr auto kPatience = std::chrono::milliseconds(800);
constexpr auto kPoll = std::chrono::milliseconds(50);

} // namespace

Interrupt::Interrupt(std::function<void()> before_end) : before_end_(std::move(before_end)) {
    try {
        watcher_ = std::jthread([this](const std::stop_token& finished) { watch(finished); });
    } catch (const std::system_error&) {
        return;
    }
    struct sigaction action = {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM})
        sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() = default;

void Interrupt::pass() {
    const std::lock_guard lock(mutex_);
    if (interrupted)
        throw Cancelled();
    passed_ = true;
}

void Interrupt::watch(const std::stop_token& finished) {
    const auto pause = [&] {
        std::unique_lock lock(mutex_);
        idle_.wait_for(lock, finished, kPoll, [] { return false; });
    };
    while (!finished.stop_requested()) {
        pause();
        if (!interrupted)
            continue;
        stop_.request_stop();
        for (auto waited = kPoll; !finished.stop_requested(); waited += kPoll) {
            pause();
            if (waited >= kPatience && !finished.stop_requested())
                end_by_force();
        }
    }
}

void Interrupt::end_by_force() {
    const std::lock_guard lock(mutex_);
    if (passed_)
        return;
    before_end_();
    show("\n");
    say("error: cancelled");
    std::_Exit(1);
}

ProgressBar::ProgressBar(std::string_view title, std::stop_token stop)
    : title_(title), stop_(std::move(stop)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
    if (terminal_)
        show("\r\033[K");
}

Progress ProgressBar::progress() {
    return {[this](double fraction) { draw(fraction); }, stop_};
}

void ProgressBar::draw(double fraction) {
    const auto now = Clock::now();
    const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
    if (now - shown_ < interval)
        return;
    shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        fraction > 0.01 ? fmt::format(", {:.0f} s left", elapsed * (1 - fraction) / fraction) : std::string();
    if (terminal_) {
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(fraction * kWidth);
        show(fmt::format("\r\033[K{} [{}{}] {:3.0f} %{}", title_,
                         std::string(static_cast<std::size_t>(filled), '#'),
                         std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * fraction, left));
    } else {
        show(fmt::format("{}: {:.0f} %{}\n", title_, 100 * fraction, left));
    }
}

std::uintmax_t Session::write(const Path& path, std::span<const std::byte> bytes) {
    if (path.empty())
        return 0;
    OutputFile& file = output(path);
    file.write(bytes);
    return file.size();
}

Host Session::host() {
    Host host;
    host.stages = [this](std::string_view title) {
        auto bar = std::make_shared<ProgressBar>(title, interrupt_.token());
        return Stage{bar->progress(), bar};
    };
    host.write = [this](const Path& path, std::span<const std::byte> bytes) { return write(path, bytes); };
    host.notify = print_notices;
    return host;
}

void Session::finish() {
    flush_output();
    outputs_.finish();
    interrupt_.pass();
    outputs_.publish();
}

void print_notices(std::string_view file, const std::vector<std::string>& notices) {
    for (const std::string& notice : notices)
        say(fmt::format("note: {}: {}", file, notice));
}

} // namespace prt::cli
