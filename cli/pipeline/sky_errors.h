#pragma once

// Measures errors of a compressed transfer under skies, at every rotation about +Y.

#include "cli/report/report.h"
#include "compress/metric/error_moments.h"
#include "compress/metric/standard_skies.h"

namespace prt::pipeline {

/// A use of a lighting: all light in the sky, or its suns separate from it.
struct LightingUse {
    Lighting lighting;
    bool separate_suns = false;
};
/// All uses of a lighting, at least one: first with all light in the sky. The lightings have the same name.
using LightingUses = std::vector<LightingUse>;
/// Returns the uses of `lighting`; its suns are separate if it has any and `layout` has a separate direct
/// term. `together`: the same light, with its suns in the sky.
LightingUses uses_of(const Lighting& lighting, Light together, const TransferLayout& layout);
/// Returns the uses of each lighting.
std::vector<LightingUses> uses_of(const std::vector<Lighting>& lightings, const TransferLayout& layout);

/// Adds table `skies` to `report`, and a sentence with the errors of each sky. Lamps are off. Does nothing if
/// the transfer has no distant light.
void add_sky_errors(const ErrorMoments& moments, const std::vector<LightingUses>& skies, Report& report);

} // namespace prt::pipeline
