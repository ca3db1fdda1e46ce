#pragma once

#include "prt/environment.h"

#include <filesystem>
#include <optional>

namespace prt {

struct ExrFile {
    Image image;
    std::optional<EnvironmentLayout> layout; ///< what the attribute `envmap` says
};

/// Whether the file is there and starts like an OpenEXR file.
bool is_exr(const std::filesystem::path& path);

/// Throws `Error` that names the file.
ExrFile read_exr(const std::filesystem::path& path);

} // namespace prt
