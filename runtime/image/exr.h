#pragma once

// Reading of OpenEXR files.

#include "prt/core/environment.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct ExrFile {
    Image image;
    std::optional<EnvironmentLayout> layout; ///< value of the attribute `envmap`
    std::vector<std::string> notices;        ///< messages for the user about how the file was read
};

/// Returns whether a file starts like an OpenEXR file.
bool is_exr(std::span<const std::byte> file);

/// Reads the layer with this name; empty: the channels without a prefix, or the only layer. Throws `Error`.
ExrFile read_exr(std::span<const std::byte> file, const std::string& layer = {});

} // namespace prt
