#pragma once

// How far light between probes is from what was measured there.

#include "volume/probe_states.h"
#include "volume/probe_tracer.h"
#include "volume/refine_bricks.h"

#include <array>
#include <span>
#include <vector>

namespace prt {

/// Squared errors under skies whose bands are about as strong as those of real ones, and under lamps.
class LightError {
public:
    explicit LightError(const IncidentLayout& layout);

    /// What is interpolated between probes against the mean of two measurements of half of a probe's rays
    /// each, [coefficients][numbers], without what noise of either adds: no smaller brick would lower that.
    BrickError operator()(const VolumeCorners& corners, const ProbeStates& states,
                          const std::array<std::span<const float>, 2>& measured) const;

private:
    /// Products of one coefficient of what comes in, over skies that may light the scene, and over lamps.
    double under_skies(std::span<const float> a, std::span<const float> b) const;
    double under_lamps(std::span<const float> a, std::span<const float> b) const;

    IncidentLayout layout_;
    std::vector<double> bands_; ///< [order²] mean square of a sky's coefficient
};

} // namespace prt
