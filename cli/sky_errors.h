#pragma once

// What a compressed transfer errs by under skies, at every turn about +Y.

#include "prt/error_moments.h"
#include "prt/standard_skies.h"
#include "report/report.h"

namespace prt::cli {

/// How a lighting is used: all of it in the sky; and its suns apart, where there are any and `layout` keeps
/// direct light apart.
struct LightingUse {
    Lighting lighting;
    bool suns_apart = false;
};
std::vector<LightingUse> uses_of(const Lighting& lighting, const TransferLayout& layout);

/// Adds table `skies` to `report`, and a sentence about each that shows its errors. Lamps are off. Nothing
/// where the transfer has no distant light.
void add_sky_errors(const ErrorMoments& moments, const std::vector<NamedLighting>& skies, Report& report);

} // namespace prt::cli
