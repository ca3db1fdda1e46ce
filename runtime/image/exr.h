#pragma once

#include "prt/environment.h"

#include <cstddef>
#include <optional>
#include <span>

namespace prt {

struct ExrFile {
    Image image;
    std::optional<EnvironmentLayout> layout; ///< what the attribute `envmap` says
};

/// Whether a file starts like an OpenEXR file.
bool is_exr(std::span<const std::byte> file);

/// Throws `Error`.
ExrFile read_exr(std::span<const std::byte> file);

} // namespace prt
