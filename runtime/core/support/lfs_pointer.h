#pragma once

// Detection of Git LFS pointers: small text files that a checkout contains instead of large files that Git
// LFS has not fetched.

#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

namespace prt {

/// Returns whether `file`, the bytes of a file, begins like a Git LFS pointer of any version ("Git LFS
/// Specification"). The rest of the file is not checked.
inline bool is_lfs_pointer(std::span<const std::byte> file) {
    constexpr std::string_view kFirstLine = "version https://git-lfs.github.com/spec/";
    return file.size() >= kFirstLine.size() &&
           std::memcmp(file.data(), kFirstLine.data(), kFirstLine.size()) == 0;
}

/// Message of the `Error` for a file that is a Git LFS pointer; the name of the file precedes it.
inline constexpr const char* kLfsRemedy =
    "is a Git LFS pointer, not the file itself; fetch the file with git lfs pull";

} // namespace prt
