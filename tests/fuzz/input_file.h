#pragma once

#include "support/temporary_folder.h"
#include "target.h"

#include <fstream>

namespace prt::fuzz {

/// A file that holds one input at a time, for readers that require a path. Its folder contains no other file.
class InputFile {
public:
    explicit InputFile(const char* name) : path_(folder_ / name) {}
    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& of(std::span<const std::byte> input) const {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
        return path_;
    }

private:
    test::TemporaryFolder folder_;
    std::filesystem::path path_;
};

} // namespace prt::fuzz
