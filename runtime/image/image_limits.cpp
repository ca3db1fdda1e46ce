// Checks image sizes against memory limits.
#include "runtime/image/image_limits.h"

#include "prt/core/error.h"

#include <string>

namespace prt {

void check_image_size(std::int64_t width, std::int64_t height, std::uint64_t bytes_per_pixel,
                      std::size_t file_bytes, std::uint64_t other_bytes) {
    if (width < 1 || height < 1)
        throw Error("has no pixels");
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
    const std::string claim = "claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels)
        throw Error(claim + "; the limit is 2^28");
    const std::uint64_t memory = static_cast<std::uint64_t>(width * height) * bytes_per_pixel + other_bytes;
    if (memory > kFreeImageMemory + kImageMemoryPerByte * file_bytes)
        throw Error(claim + " in a file of " + std::to_string(file_bytes) + " bytes and would need " +
                    std::to_string((memory >> 20) + 1) + " MB of memory; the limit is " +
                    std::to_string(kFreeImageMemory >> 20) + " MB plus " +
                    std::to_string(kImageMemoryPerByte) + " times the size of the file");
}

} // namespace prt
