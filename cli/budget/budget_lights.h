#pragma once

// Lights as a budget of errors is measured under them: as they are, and as coefficients.

#include "prt/surface_radiance.h"
#include "split_light.h"

#include <string>
#include <vector>

namespace prt::cli {

struct BudgetLight {
    std::string name;
    MeasuredLight measured;

    /// Of the sky, as it is drawn with so many bands: by `deringed`.
    BandFactors factors(int order) const;
    /// What transfer of that order is lit with; suns are in the sky unless they are apart.
    Lighting lighting(int order) const;
};

/// How lights come in.
struct BudgetLightOptions {
    std::vector<Path> files; ///< none: the default lights of `evaluate`
    SunCount suns = {std::nullopt};
    LightOptions reading;
    int order = 6;     ///< of the transfer, by which suns are looked for
    bool apart = true; ///< suns can be: transfer keeps direct light apart
    int threads = 0;
};

/// Environment maps, turned by whole texels. Of light files and analytic lights there is no more than their
/// bands and suns: the sky is drawn from kMaxOrder of them.
std::vector<BudgetLight> budget_lights(const BudgetLightOptions& options);

} // namespace prt::cli
