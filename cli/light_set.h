#pragma once

// Light sets: which distant lights `bake` keeps, and suns that shine by them.

#include "lamp_strengths.h"
#include "prt/scene.h"
#include "split_light.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
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

/// [layout.lamps()]: lamps as `lamps` says; where shadows are baked, keys of the model's light set shine for
/// the suns of `light`, which then has none, and a note says where one stands far from all keys. Throws
/// `Error` where there are no keys.
std::vector<glm::vec3> strengths_under(const Path& model, const TransferLayout& layout,
                                       const LampChoice& lamps, SunShadows shadows, SplitLight& light);

} // namespace prt::cli
