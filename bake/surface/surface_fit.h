#pragma once

#include "surface/fit_solver.h"

namespace prt {

/// Samples of the surface, and the operator from light at them to light at receivers (section 14 of
/// docs/math.md).
struct SurfaceFit {
    SurfaceSamples samples;
    FitEquations equations;
    FitSolver solver; ///< for any light

    /// Of light at the samples [samples][stride] that of receivers.
    void apply(std::span<const float> at_samples, std::span<float> at_receivers, std::size_t stride,
               int threads) const;
};

} // namespace prt
