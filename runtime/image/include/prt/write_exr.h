#pragma once

// Images into files that the caller publishes. Experimental.

#include "prt/image_file.h"
#include "prt/support/file.h"

namespace prt {

/// As `write_exr` of a path.
void write_exr(const OutputFile& output, const Image& image,
               std::optional<EnvironmentLayout> layout = std::nullopt);

} // namespace prt
