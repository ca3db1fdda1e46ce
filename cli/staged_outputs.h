#pragma once

#include "prt/support/file.h"

#include <memory>
#include <mutex>
#include <vector>

namespace prt::cli {

/// What a command writes: all of it appears at the end, together, or none.
class StagedOutputs {
public:
    OutputFile& add(const std::filesystem::path& path);
    /// To disk, and into pipes, which cannot be taken back. Throws `Error` when that fails.
    void finish();
    /// Throws `Error` when that fails, with all as it was.
    void publish();
    /// For a process that is about to end, from any thread.
    void remove_names() noexcept;

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<OutputFile>> files_;
};

} // namespace prt::cli
