#pragma once

// Lights for an error budget: as measured, and as coefficients.

#include "prt/surface_radiance.h"
#include "split_light.h"

#include <string>
#include <vector>

namespace prt::cli {

struct BudgetLight {
    std::string name;
    ReferenceLight measured;

    /// Returns the factors of `deringed` on the bands of the sky at this order.
    BandFactors factors(int order) const;
    /// Returns the lighting for transfer of this order; suns are in the sky unless they are separate.
    Lighting lighting(int order) const;
};

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
std::vector<BudgetLight> budget_lights(const BudgetLightOptions& options);

} // namespace prt::cli
