#pragma once

#include "prt/support/progress.h"
#include "staged_outputs.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace prt::cli {

using Path = std::filesystem::path;

/// Ctrl-C and SIGTERM. Work that watches the stop token ends by itself; what does not is ended by force
/// before a second has passed. Where no thread can be had to watch, the signals end the program at once.
class Interrupt {
public:
    /// `before_end` is called before the program is ended by force, from another thread.
    explicit Interrupt(std::function<void()> before_end);
    ~Interrupt();
    std::stop_token token() const { return stop_.get_token(); }
    /// From here on the program is not ended any more. Throws `Cancelled` where it was to end before.
    void pass();

private:
    void watch(const std::stop_token& finished);
    void end_by_force();
    std::function<void()> before_end_;
    std::stop_source stop_;
    std::mutex mutex_; ///< held while one of the two ends is chosen
    bool passed_ = false;
    std::condition_variable_any idle_; ///< made here, where failing to is no end of the thread
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
    void draw(double fraction);
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
    /// A file to fill, published by `finish`.
    OutputFile& output(const Path& path) { return outputs_.add(path); }
    /// Writes such a file. An empty path: nothing is written. Returns its size in bytes.
    std::uintmax_t write(const Path& path, std::span<const std::byte> bytes);
    std::uintmax_t write(const Path& path, std::string_view text) {
        return write(path, std::as_bytes(std::span(text)));
    }
    /// Says that all went well: everything that was printed and written arrives, or nothing of what was
    /// written. Throws `Error`.
    void finish();
    /// The program ends with this status, though all went well: a check has found something.
    void set_status(int status) { status_ = status; }
    int status() const { return status_; }

private:
    std::string command_line_;
    int status_ = 0;
    StagedOutputs outputs_;
    Interrupt interrupt_{[this] { outputs_.remove_names(); }};
};

/// A line on stderr for each notice about `file`.
void print_notices(std::string_view file, const std::vector<std::string>& notices);

} // namespace prt::cli
