#pragma once

// Detection of Git LFS pointers: small files that replace files which were not fetched.

#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

namespace prt {

/// Returns whether a file is a Git LFS pointer ("Git LFS Specification", the pointer's first line).
inline bool is_lfs_pointer(std::span<const std::byte> file) {
    constexpr std::string_view kFirstLine = "version https://git-lfs.github.com/spec/";
    return file.size() >= kFirstLine.size() &&
           std::memcmp(file.data(), kFirstLine.data(), kFirstLine.size()) == 0;
}

/// Message for the user after the name of such a file.
inline constexpr const char* kLfsRemedy =
    "is a Git LFS pointer, not the file itself; fetch the file with git lfs pull";

} // namespace prt
