#pragma once

#include "prt/environment.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct ExrFile {
    Image image;
    std::optional<EnvironmentLayout> layout; ///< what the attribute `envmap` says
    std::vector<std::string> notices;        ///< what a user should know about how it was read
};

/// Whether a file starts like an OpenEXR file.
bool is_exr(std::span<const std::byte> file);

/// Reads the layer of this name; empty: the plain channels, or the only layer. Throws `Error`.
ExrFile read_exr(std::span<const std::byte> file, const std::string& layer = {});

} // namespace prt
