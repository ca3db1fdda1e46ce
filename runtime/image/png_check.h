#pragma once

#include "prt/image_size.h"

#include <cstddef>
#include <span>

namespace prt {

/// Throws `Error` for a critical chunk that PNG does not have: stb puts its name into a text that all threads
/// share.
void check_png_chunks(std::span<const std::byte> file);

/// Throws `Error` where stb would take memory for bytes that a PNG of `size` does not have: chunks that reach
/// beyond its end, and pixels that inflate to more than the header says, of which one byte can make a
/// thousand.
void check_png(std::span<const std::byte> file, ImageSize size);

} // namespace prt
