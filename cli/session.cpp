#include "session.h"

#include "prt/support/file.h"

#include <fmt/core.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

#include <unistd.h>

namespace prt::cli {
namespace {

/// Set by whatever thread gets the signal: libraries start threads before main, so that blocking signals here
/// would not keep them from ending the program.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // what a signal handler may touch

constexpr auto kPatience = std::chrono::milliseconds(800);
constexpr auto kPoll = std::chrono::milliseconds(50);

} // namespace

Interrupt::Interrupt() {
    struct sigaction action = {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM})
        sigaction(signal, &action, nullptr);
    watcher_ = std::jthread([this](const std::stop_token& finished) { watch(finished); });
}

Interrupt::~Interrupt() = default;

void Interrupt::watch(const std::stop_token& finished) {
    while (!finished.stop_requested()) {
        std::this_thread::sleep_for(kPoll);
        if (!interrupted)
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
        fraction > 0.01 ? fmt::format(", {:.0f} s left", elapsed * (1 - fraction) / fraction) : std::string();
    if (terminal_) {
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(fraction * kWidth);
        fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %{}", title_,
                   std::string(static_cast<std::size_t>(filled), '#'),
                   std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * fraction, left);
    } else {
        fmt::print(stderr, "{}: {:.0f} %{}\n", title_, 100 * fraction, left);
    }
}

void Session::write(const std::function<void()>& save) {
    const Interrupt::WritingScope writing(interrupt_);
    save();
}

void Session::write(const Path& path, std::string_view text) {
    if (!path.empty())
        write([&] {
            OutputFile file(path);
            file.write(text);
            file.commit();
        });
}

void print_notices(std::string_view file, const std::vector<std::string>& notices) {
    for (const std::string& notice : notices)
        fmt::print(stderr, "prt: note: {}: {}\n", file, notice);
}

} // namespace prt::cli
