// Publishes all output files together.

#include "cli/program/staged_outputs.h"

namespace prt::cli {

OutputFile& StagedOutputs::add(const std::filesystem::path& path) {
    const std::lock_guard lock(mutex_);
    files_.push_back(std::make_unique<OutputFile>(path));
    return *files_.back();
}

void StagedOutputs::finish() {
    for (const auto& file : files_)
        file->finish();
    for (const auto& file : files_)
        if (file->is_stream())
            file->publish();
}

void StagedOutputs::publish() {
    try {
        for (const auto& file : files_)
            if (!file->is_stream())
                file->publish();
    } catch (...) {
        files_.clear(); // restores the previous files
        throw;
    }
    for (const auto& file : files_)
        file->keep();
}

void StagedOutputs::remove_names() noexcept {
    const std::lock_guard lock(mutex_);
    for (const auto& file : files_)
        file->remove_name();
}

} // namespace prt::cli
