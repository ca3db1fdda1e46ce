#pragma once

// One run of the program: progress, interruption and outputs.

#include "cli/pipeline/host.h"
#include "cli/program/staged_outputs.h"
#include "prt/core/progress.h"

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

using namespace pipeline;

/// Handles Ctrl-C and SIGTERM. Work that checks the stop token ends itself; other work is terminated within a
/// second. If no thread can be created to watch, the signals terminate the program at once.
class Interrupt {
public:
    /// `before_end` is called from another thread before the program is terminated.
    explicit Interrupt(std::function<void()> before_end);
    ~Interrupt();
    std::stop_token token() const { return stop_.get_token(); }
    /// Ignores interrupts from now on. Throws `Cancelled` if one arrived before.
    void pass();

private:
    void watch(const std::stop_token& finished);
    void end_by_force();
    std::function<void()> before_end_;
    std::stop_source stop_;
    std::mutex mutex_; ///< held while choosing between `pass` and termination
    bool passed_ = false;
    /// constructed here, because failing inside the thread would terminate the program
    std::condition_variable_any idle_;
    std::jthread watcher_;
};

/// Shows the progress of work: a bar with the remaining time on a terminal, plain lines in a log.
class ProgressBar {
public:
    ProgressBar(std::string_view title, std::stop_token stop);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete; // the result of `progress` refers to it
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

/// One run of the program: its command line, its interruption, and its outputs. Create it first in main,
/// before any thread.
class Session {
public:
    explicit Session(std::string command_line) : command_line_(std::move(command_line)) {}
    const std::string& command_line() const { return command_line_; }

    ProgressBar progress_bar(std::string_view title) const { return {title, interrupt_.token()}; }
    /// Returns the connections of a pipeline to this run; they refer to this object.
    Host host();
    /// Returns a new output file, which `finish` publishes.
    OutputFile& output(const Path& path) { return outputs_.add(path); }
    /// Writes a file that `finish` publishes, and returns its size in bytes. Does nothing if the path is
    /// empty.
    std::uintmax_t write(const Path& path, std::span<const std::byte> bytes);
    std::uintmax_t write(const Path& path, std::string_view text) {
        return write(path, std::as_bytes(std::span(text)));
    }
    /// Completes the run: all printed and written data must arrive, or no file is published. Throws `Error`.
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

/// Prints a line on stderr for each notice about `file`.
void print_notices(std::string_view file, const std::vector<std::string>& notices);

} // namespace prt::cli
