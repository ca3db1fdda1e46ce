#pragma once

// Light sets: which distant lights `bake` keeps, and suns that shine by them.

#include "prt/scene.h"
#include "split_light.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <span>
#include <vector>

namespace prt::cli {

/// The keys of a light set of docs/format.md. Throws `Error` that names the file.
std::vector<PunctualLight> read_light_set(const std::filesystem::path& path);

enum class SunShadows {
    sharp, ///< found where a picture, or a vertex, is lit
    baked, ///< of the keys of the model's light set
};

/// --sun-shadows
void add_sun_shadows(CLI::App* command, SunShadows& shadows);

/// Takes the suns out of `light` and lets the keys of the model's light set shine for them in `strengths`
/// [layout.lamps()]. Says so where one stands far from all keys. Throws `Error` where there are none.
void shine_by_keys(const Path& model, const TransferLayout& layout, SplitLight& light,
                   std::span<glm::vec3> strengths);

} // namespace prt::cli
