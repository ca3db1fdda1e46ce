#include "session.h"

#include <fmt/core.h>

#include <csignal>
#include <cstdlib>
#include <ctime>

#include <unistd.h>

namespace prt::cli {
namespace {

sigset_t interrupt_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

constexpr auto kPatience = std::chrono::milliseconds(800);
constexpr auto kPoll = std::chrono::milliseconds(50);

} // namespace

Interrupt::Interrupt() {
    // Blocked here and in all threads that follow; only the watcher takes them, so no handler runs anywhere.
    const sigset_t signals = interrupt_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    watcher_ = std::jthread([this](const std::stop_token& finished) { watch(finished); });
}

Interrupt::~Interrupt() = default;

void Interrupt::watch(const std::stop_token& finished) {
    const sigset_t signals = interrupt_signals();
    const timespec poll{0, std::chrono::nanoseconds(kPoll).count()};
    while (!finished.stop_requested()) {
        if (sigtimedwait(&signals, nullptr, &poll) < 0)
            continue;
        stop_.request_stop();
        for (auto waited = kPoll; !finished.stop_requested(); waited += kPoll) {
            std::this_thread::sleep_for(kPoll);
            if (waited >= kPatience && writing_ == 0) {
                fmt::print(stderr, "\nprt: error: cancelled\n");
                std::_Exit(1);
            }
        }
    }
}

ProgressBar::ProgressBar(std::string_view title, std::stop_token stop)
    : title_(title), stop_(std::move(stop)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
    if (terminal_)
        fmt::print(stderr, "\r\033[K");
}

Progress ProgressBar::progress() {
    return {[this](double fraction) { show(fraction); }, stop_};
}

void ProgressBar::show(double fraction) {
    const auto now = Clock::now();
    const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
    if (now - shown_ < interval)
        return;
    shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        fraction > 0.01 ? fmt::format("{:.0f} s left", elapsed * (1 - fraction) / fraction) : std::string();
    if (terminal_) {
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(fraction * kWidth);
        fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %  {}", title_,
                   std::string(static_cast<std::size_t>(filled), '#'),
                   std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * fraction, left);
    } else {
        fmt::print(stderr, "{}: {:.0f} %, {}\n", title_, 100 * fraction, left);
    }
}

void print_notices(std::string_view file, const std::vector<std::string>& notices) {
    for (const std::string& notice : notices)
        fmt::print(stderr, "prt: note: {}: {}\n", file, notice);
}

} // namespace prt::cli
