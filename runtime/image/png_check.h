#pragma once

// Validation of PNG files.

#include "runtime/image/image_size.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Returns the bit depth from the header of a PNG.
int png_bit_depth(std::span<const std::byte> file);

/// Throws `Error` for an unknown critical chunk: stb writes its name into a static text that all threads
/// share.
void check_png_chunks(std::span<const std::byte> file);

/// Throws `Error` if stb would allocate memory for data that a PNG of `size` does not have: chunks beyond the
/// end of the file, and pixels that inflate to more than the header allows (one byte can inflate to a
/// thousand).
void check_png(std::span<const std::byte> file, ImageSize size);

/// Returns the file with its palette extended to 256 colors with black: for pixels beyond the palette stb
/// reads uninitialised memory. Returns an empty vector if the palette is complete.
std::vector<std::byte> with_whole_palette(std::span<const std::byte> file);

} // namespace prt
