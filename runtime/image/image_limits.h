#pragma once

// How much memory an image may take, asked before any is taken.

#include <cstddef>
#include <cstdint>

namespace prt {

/// What images claim is taken on trust up to so many bytes of memory, and 64 more for each byte of their
/// files: real ones need a few.
inline constexpr std::uint64_t kFreeImageMemory = std::uint64_t{192} << 20;
inline constexpr std::uint64_t kImageMemoryPerByte = 64;

/// Throws `Error` where an image has no pixels, more than 2^28, or takes more memory than its file of
/// `file_bytes` gives it. `bytes_per_pixel`: what is held at once while it is read; `other_bytes` comes to
/// it.
void check_image_size(std::int64_t width, std::int64_t height, std::uint64_t bytes_per_pixel,
                      std::size_t file_bytes, std::uint64_t other_bytes = 0);

} // namespace prt
