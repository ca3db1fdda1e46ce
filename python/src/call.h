#pragma once

// One call of a long function from Python: progress, notices, files and interruption.

#include "cli/pipeline/host.h"

#include <pybind11/pybind11.h>

#include <cstddef>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace prt::python {

namespace py = pybind11;

/// Requests a stop when Ctrl-C is pressed, while it exists and if the calling thread is the main thread.
/// Python's own handler is called too, so that Python raises KeyboardInterrupt.
class InterruptWatch {
public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;
    std::stop_token token() const { return stop_.get_token(); }

private:
    bool installed_ = false;
    std::stop_source stop_;
    std::jthread watcher_; ///< polls the flag that the signal handler sets
};

/// Connections of a pipeline to a Python caller. Create and destroy it while holding the GIL.
class Call {
public:
    /// `progress`: None, or a function of the title of the stage and of its finished fraction, 0..1.
    explicit Call(py::object progress) : progress_(std::move(progress)) {}

    /// Runs `work` without the GIL and returns its result. Raises KeyboardInterrupt after Ctrl-C.
    template <class Work>
    auto run(Work&& work) {
        const InterruptWatch watch;
        stop_ = watch.token();
        try {
            const py::gil_scoped_release release;
            return work();
        } catch (const Cancelled&) {
            raise_interrupt();
            throw;
        }
    }
    /// Returns the connections; they refer to this object. Files are kept in memory.
    pipeline::Host host();
    /// Returns the progress of work with this title.
    Progress progress(const std::string& title);
    /// Returns the file that was written to `path`. It must exist.
    std::vector<std::byte> take(const pipeline::Path& path) { return std::move(files_.at(path)); }
    const std::vector<std::string>& notices() const { return notices_; }

private:
    static void raise_interrupt();
    void report(const std::string& title, double fraction);

    py::object progress_;
    std::stop_token stop_;
    std::map<pipeline::Path, std::vector<std::byte>> files_;
    std::vector<std::string> notices_;
};

} // namespace prt::python
