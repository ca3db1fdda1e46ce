#pragma once

// How far light between probes is from what was measured there.

#include "volume/probe_states.h"
#include "volume/probe_tracer.h"
#include "volume/refine_bricks.h"

#include <span>
#include <vector>

namespace prt {

/// Squared errors under skies whose bands are about as strong as those of real ones, and under lamps.
class LightError {
public:
    explicit LightError(const IncidentLayout& layout);

    /// What is interpolated between probes against `measured` [coefficients][numbers].
    BrickError operator()(const VolumeCorners& corners, const ProbeStates& states,
                          std::span<const float> measured) const;

private:
    double under_skies(std::span<const float> of_coefficient) const;
    double under_lamps(std::span<const float> of_coefficient) const;

    IncidentLayout layout_;
    std::vector<double> bands_; ///< [order²] mean square of a sky's coefficient
};

} // namespace prt
