#pragma once

// Connections of a pipeline to its program: progress, notices and output files.

#include "prt/core/progress.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prt::pipeline {

using Path = std::filesystem::path;

/// Receives notices about `file`, one line each. May be empty.
using Notify = std::function<void(const std::string& file, const std::vector<std::string>& notices)>;

/// Passes `notices` to `notify` if both have content.
inline void send(const Notify& notify, const Path& file, const std::vector<std::string>& notices) {
    if (notify && !notices.empty())
        notify(file.string(), notices);
}

/// A stage of work. Its progress is shown while `shown` exists.
struct Stage {
    Progress progress;
    std::shared_ptr<const void> shown = {};
};
/// Begins a stage with this title.
using Stages = std::function<Stage(std::string_view title)>;

/// Writes a file and returns its size in bytes. Does nothing and returns 0 if `path` is empty.
using WriteFile = std::function<std::uintmax_t(const Path& path, std::span<const std::byte> bytes)>;

/// Functions of the program that a pipeline calls.
struct Host {
    Stages stages;
    WriteFile write;
    Notify notify;
};

} // namespace prt::pipeline
