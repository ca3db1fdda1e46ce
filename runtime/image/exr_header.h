#pragma once

// Validation of OpenEXR headers.

#include <cstddef>
#include <span>

namespace prt {

/// Reads the headers of an EXR file with OpenEXR's core library, which accepts no size beyond the file.
/// `Imf::InputFile` allocates memory for attributes, for tables of all lines and tiles and for whole chunks
/// before it reads them. Throws `Error` if these sizes exceed the file.
void check_exr_header(std::span<const std::byte> file);

} // namespace prt
