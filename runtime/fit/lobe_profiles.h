#pragma once

// The few profiles that all lobes of a model share.

#include "prt/lobe_fit.h"

#include <span>
#include <vector>

namespace prt {

/// What a profile and its factor err by costs so much per band: cost_l (2l + 1) / 4π.
std::array<double, kMostLobeOrder> profile_costs(int order, const LobeFitOptions& options);

/// At most options.profiles, the first of them the cosine lobe of an open vertex, so that it is there
/// exactly. `areas`: [lobes]. Each profile is as large as the largest lobe of it: factors are 0..1.
std::vector<LobeProfile> shared_profiles(int order, std::span<const Lobe> lobes, std::span<const float> areas,
                                         const LobeFitOptions& options);

/// The clamped cosine.
LobeProfile cosine_profile(int order);

} // namespace prt
