#pragma once

// Lights for an error budget: as measured, and as coefficients.

#include "bake/reference/surface_radiance.h"
#include "cli/pipeline/loaded_light.h"

#include <vector>

namespace prt::pipeline {

/// How lights come in.
struct BudgetLightOptions {
    std::vector<Path> files; ///< empty: the default lights of `evaluate`
    SunCount suns = {std::nullopt};
    LightOptions reading;
    int order = 6;        ///< order of the transfer; suns are searched for with it
    bool separate = true; ///< suns may be separate, because the transfer has a separate direct term
    int threads = 0;
};

/// Loads the lights. Environment maps are rotated by a whole number of texels. Light files and analytic
/// lights have only their bands and suns: their sky is drawn from kMaxOrder bands.
std::vector<ReferenceLight> budget_lights(const BudgetLightOptions& options);

} // namespace prt::pipeline
