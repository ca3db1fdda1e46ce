#pragma once

// Light files, as `prt project` writes them (docs/format.md). Stable.

#include "prt/core/light.h"

#include <filesystem>
#include <vector>

namespace prt {

/// Content of a light file.
struct LightFile {
    Light sky;             ///< distant light without the light of `suns`
    std::vector<Sun> suns; ///< suns that are separate from `sky`; empty if the file has no suns
};

/// Reads a light file with all of its bands. Throws `Error`, with the file name, if the file cannot be read
/// or is not a valid light file.
LightFile read_light_file(const std::filesystem::path& path);
/// Reads a light file and keeps the first `order` bands of its sky. Throws `Error`, with the file name, if
/// the file cannot be read, is not a valid light file, or has fewer than `order` bands.
LightFile read_light_file(const std::filesystem::path& path, int order);

/// Returns the sum of the sky and of all suns as SH coefficients, with the order of the sky. Throws the
/// errors of `as_light`, and `Error` if a sum with a sun is not finite. Without suns, the result is the sky,
/// unchecked.
Light all_light(const LightFile& file);

} // namespace prt
