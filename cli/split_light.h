#pragma once

// Lighting with its suns apart.

#include "inputs.h"
#include "prt/suns.h"
#include "prt/transfer_layout.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace prt::cli {

/// How many suns to take out: none, so many, or as many as pay.
struct SunCount {
    std::optional<int> count = 0; ///< unset: as many as pay
};

/// --suns
void add_suns(CLI::App* command, SunCount& suns, const std::string& text, const std::string& otherwise);

/// A sky without its suns, and what was found of them.
struct SplitLight {
    LoadedLight sky;
    SunSplit split;
    Light whole; ///< all of it together, as `load_light` gives it
};

/// The suns together, as they light what is lit after a bounce.
Light light_of_suns(const SplitLight& light);

/// Its suns' light goes through `direct` transfer apart from the sky's, where there are any.
Lighting lighting_of(const SplitLight& light);

/// Why suns cannot be lit apart from the sky where transfer is one part, and what to do about it.
inline constexpr const char* kNotApart = "keeps no direct light apart, so that suns cannot be lit apart from "
                                         "the sky; lobes never do, other transfer without --whole";

/// Without light.
SplitLight dark_sky(int order);

/// The same with its suns in its sky.
SplitLight together(SplitLight light);

/// Turned about +Y, as `rotated_about_y`, without its image.
SplitLight turned(SplitLight light, double angle);

/// Takes suns out of an environment map, or those of a light file, whose number is its own unless none is
/// asked for; turned with the rest as asked. A window is for the rest alone.
SplitLight load_split_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                            int threads);

} // namespace prt::cli
