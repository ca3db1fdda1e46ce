#pragma once

#include <cstddef>
#include <span>

namespace prt {

/// Reads the headers of an EXR file with OpenEXR's core library, which believes no size beyond the file's.
/// `Imf::InputFile` takes memory for attributes, for tables of all lines and tiles and for whole chunks
/// before it reads them. Throws `Error` where they claim more than the file can hold.
void check_exr_header(std::span<const std::byte> file);

} // namespace prt
