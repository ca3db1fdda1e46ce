#pragma once

#include "prt/support/progress.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace prt::cli {

using Path = std::filesystem::path;

/// Ctrl-C and SIGTERM. Work that watches the stop token ends by itself; what does not is ended by force
/// before a second has passed, unless a file is being written.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    std::stop_token token() const { return stop_.get_token(); }

    /// While alive, the program is not ended by force.
    class WritingScope {
    public:
        explicit WritingScope(Interrupt& interrupt) : interrupt_(interrupt) { ++interrupt_.writing_; }
        ~WritingScope() { --interrupt_.writing_; }
        WritingScope(const WritingScope&) = delete;
        WritingScope& operator=(const WritingScope&) = delete;

    private:
        Interrupt& interrupt_;
    };

private:
    void watch(const std::stop_token& finished);
    std::stop_source stop_;
    std::atomic<int> writing_ = 0;
    std::jthread watcher_;
};

/// Shows how far a piece of work is: a bar with the time left on a terminal, plain lines in a log.
class ProgressBar {
public:
    ProgressBar(std::string_view title, std::stop_token stop);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete; // what `progress` returns refers to it
    ProgressBar& operator=(const ProgressBar&) = delete;
    Progress progress();

private:
    using Clock = std::chrono::steady_clock;
    void show(double fraction);
    std::string title_;
    std::stop_token stop_;
    bool terminal_;
    Clock::time_point start_ = Clock::now(), shown_ = start_;
};

/// One run of the program: how it was called, when it is to end, and what it writes. Make it first thing in
/// main, before any thread.
class Session {
public:
    explicit Session(std::string command_line) : command_line_(std::move(command_line)) {}
    const std::string& command_line() const { return command_line_; }

    ProgressBar progress_bar(std::string_view title) const { return {title, interrupt_.token()}; }
    /// Calls `save`, which writes a file and is not cut short.
    void write(const std::function<void()>& save);
    /// Writes `text`, all or nothing. An empty path: nothing is written.
    void write(const Path& path, std::string_view text);

private:
    std::string command_line_;
    Interrupt interrupt_;
};

/// A line on stderr for each notice about `file`.
void print_notices(std::string_view file, const std::vector<std::string>& notices);

} // namespace prt::cli
