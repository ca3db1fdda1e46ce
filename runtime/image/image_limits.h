#pragma once

// Memory limits of images, checked before allocation.

#include <cstddef>
#include <cstdint>

namespace prt {

/// Accepted memory for the size that an image header claims: a fixed number of bytes, plus a number for each
/// byte of the file. Real images need only a few bytes per byte of the file.
inline constexpr std::uint64_t kFreeImageMemory = std::uint64_t{192} << 20;
inline constexpr std::uint64_t kImageMemoryPerByte = 64;

/// Throws `Error` if an image has no pixels, more than 2^28, or needs more memory than allowed for a file of
/// `file_bytes`. `bytes_per_pixel`: peak memory per pixel while reading; `other_bytes` is added.
void check_image_size(std::int64_t width, std::int64_t height, std::uint64_t bytes_per_pixel,
                      std::size_t file_bytes, std::uint64_t other_bytes = 0);

} // namespace prt
