#pragma once

// Lighting with separate suns.

#include "inputs.h"
#include "prt/suns.h"
#include "prt/transfer_layout.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace prt::cli {

/// Number of suns to separate: zero, a fixed number, or automatic.
struct SunCount {
    std::optional<int> count = 0; ///< unset: all that are worth separating
};

/// --suns
void add_suns(CLI::App* command, SunCount& suns, const std::string& text, const std::string& otherwise);

/// A sky without its suns, and the suns found.
struct SplitLight {
    LoadedLight sky;
    SunSplit split;
    Light whole; ///< sky and suns together, as `load_light` returns it
};

/// Returns the sum of the suns as light, used for light after a bounce.
Light light_of_suns(const SplitLight& light);

/// Returns the lighting of sky and suns; light of the suns uses `direct` transfer separately from the sky.
Lighting lighting_of(const SplitLight& light);

/// Error message: transfer without a separate direct term cannot be lit by separate suns, with advice.
inline constexpr const char* kNoDirectTerm =
    "has no separate direct term, so suns cannot be separate from the sky; compress without --combine-direct "
    "(lobes never have a direct term)";

/// Returns a sky without light.
SplitLight dark_sky(int order);

/// Returns the light with its suns in its sky.
SplitLight together(SplitLight light);

/// Returns the light rotated about +Y, as by `rotated_about_y`, without its image.
SplitLight rotated(SplitLight light, double angle);

/// Separates suns from an environment map, or reads those of a light file; the default number for a light
/// file is the number of suns in it. All are rotated as `options` requires. The window filters the rest only.
SplitLight load_split_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                            int threads);

} // namespace prt::cli
