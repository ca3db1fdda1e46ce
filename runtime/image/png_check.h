#pragma once

#include "prt/image_size.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Bits of a sample, as the header of a PNG says.
int png_bit_depth(std::span<const std::byte> file);

/// Throws `Error` for a critical chunk that PNG does not have: stb puts its name into a text that all threads
/// share.
void check_png_chunks(std::span<const std::byte> file);

/// Throws `Error` where stb would take memory for bytes that a PNG of `size` does not have: chunks that reach
/// beyond its end, and pixels that inflate to more than the header says, of which one byte can make a
/// thousand.
void check_png(std::span<const std::byte> file, ImageSize size);

/// The file with a palette of 256 colors, black where it had none: stb looks pixels up in memory that it
/// never wrote where they lie beyond the palette. Empty where nothing is missing.
std::vector<std::byte> with_whole_palette(std::span<const std::byte> file);

} // namespace prt
