#pragma once

// Error of the interpolation between probes, relative to measured light.

#include "bake/products/volumes/probe_states.h"
#include "bake/products/volumes/probe_tracer.h"
#include "bake/products/volumes/refine_bricks.h"

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Computes squared errors under skies with band energies similar to real ones, and under lamps.
class LightError {
public:
    explicit LightError(const IncidentLayout& layout);

    /// Compares the interpolation between probes with two measurements from half of a probe's rays each,
    /// [coefficients][numbers]. The noise of both is removed, because smaller bricks would not reduce it.
    BrickError operator()(const VolumeCorners& corners, const ProbeStates& states,
                          const std::array<std::span<const float>, 2>& measured) const;

private:
    /// Product of one coefficient of incident light over assumed skies.
    double under_skies(std::span<const float> a, std::span<const float> b) const;
    /// Product of one coefficient of incident light over lamps.
    double under_lamps(std::span<const float> a, std::span<const float> b) const;

    IncidentLayout layout_;
    std::vector<double> bands_; ///< [order²] mean square of a sky's coefficient
};

} // namespace prt
