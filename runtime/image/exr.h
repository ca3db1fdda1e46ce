#pragma once

#include "prt/environment.h"

#include <filesystem>
#include <optional>

namespace prt {

struct ExrFile {
    Image image;
    std::optional<EnvironmentLayout> layout; ///< what the attribute `envmap` says
};

/// Throws `Error` that names the file.
ExrFile read_exr(const std::filesystem::path& path);

} // namespace prt
