#pragma once

#include "runtime/core/support/file.h"

#include <memory>
#include <mutex>
#include <vector>

namespace prt::cli {

/// Output files of a command: all of them appear together at the end, or none.
class StagedOutputs {
public:
    OutputFile& add(const std::filesystem::path& path);
    /// Writes to disk, and to pipes, which cannot be undone. Throws `Error` on failure.
    void finish();
    /// Publishes all files. Throws `Error` on failure, after restoring the previous state.
    void publish();
    /// Removes temporary files of a process that is about to end; callable from any thread.
    void remove_names() noexcept;

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<OutputFile>> files_;
};

} // namespace prt::cli
