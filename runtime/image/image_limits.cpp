// Checks image sizes against memory limits.
#include "image_limits.h"

#include "prt/support/error.h"

#include <string>

namespace prt {

void check_image_size(std::int64_t width, std::int64_t height, std::uint64_t bytes_per_pixel,
                      std::size_t file_bytes, std::uint64_t other_bytes) {
    if (width < 1 || height < 1)
        throw Error("has no pixels");
    constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
    const std::string claim = "claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels)
        throw Error(claim + ", more than the 2^28 that are read");
    const std::uint64_t memory = static_cast<std::uint64_t>(width * height) * bytes_per_pixel + other_bytes;
    if (memory > kFreeImageMemory + kImageMemoryPerByte * file_bytes)
        throw Error(claim + " in a file of " + std::to_string(file_bytes) + " bytes, which would take " +
                    std::to_string((memory >> 20) + 1) +
                    " MB of memory: " + std::to_string(kFreeImageMemory >> 20) + " MB are given and " +
                    std::to_string(kImageMemoryPerByte) + " bytes for each byte of a file");
}

} // namespace prt
