#pragma once

// Light of a file, with separate suns if requested.

#include "cli/pipeline/model.h"
#include "prt/core/transfer_layout.h"
#include "prt/fit/suns.h"

#include <optional>

namespace prt::pipeline {

/// Number of suns to separate: zero, a fixed number, or automatic.
struct SunCount {
    std::optional<int> count = 0; ///< unset: all that are worth separating
};

/// Light of an environment map, of a light file or built in.
struct LoadedLight {
    std::string name; ///< for reports: the name of the file
    Light sky;        ///< light without the suns of `split`
    Light combined;   ///< light of sky and suns
    /// The separate suns; all other members have values only for suns that were found in `environment`.
    SunSplit split = {};
    std::optional<Environment> environment = {}; ///< the image, not rotated, if the light comes from one
};

/// Returns the sum of the suns as light, used for light after a bounce.
Light light_of_suns(const LoadedLight& light);

/// Returns the lighting of sky and suns; light of the suns uses `direct` transfer separately from the sky.
Lighting lighting_of(const LoadedLight& light);

/// Error message: transfer without a separate direct term cannot be lit by separate suns, with advice.
inline constexpr const char* kNoDirectTerm =
    "has no separate direct term, so suns cannot be separate from the sky; compress without --combine-direct "
    "(lobes never have a direct term)";

/// Returns a sky without light.
LoadedLight dark_sky(int order);

/// Returns the light with its suns in its sky.
LoadedLight together(LoadedLight light);

/// Returns the suns rotated about +Y, as by `rotated_about_y`; `angle` in radians.
std::vector<Sun> rotated(std::vector<Sun> suns, double angle);

/// Returns the light rotated about +Y, as by `rotated_about_y`, without its image.
LoadedLight rotated(LoadedLight light, double angle);

/// Returns the light of an environment map, as `load_light` does for a file.
LoadedLight light_of_environment(Environment image, int order, const SunCount& suns,
                                 const LightOptions& options, int threads);

/// Loads light from an environment map or a light file, windowed and rotated, with `order` bands. Separates
/// suns from an environment map, or reads those of a light file; the default number for a light file is the
/// number of suns in it. All are rotated as `options` requires. The window filters the rest only. With
/// `SunCount{0}` all light is in the sky.
LoadedLight load_light(const Path& path, int order, const SunCount& suns, const LightOptions& options,
                       int threads);

} // namespace prt::pipeline
