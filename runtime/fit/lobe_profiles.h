#pragma once

// Clustering of lobes into a few profiles that all lobes of a model share.

#include "prt/fit/lobe_fit.h"

#include <span>
#include <vector>

namespace prt {

/// Throws `Error` for a number of bands, lobes, profiles, vectors or areas that cannot be fitted, and for
/// vectors that are not finite.
void check_targets(const LobeTargets& targets, const LobeFitOptions& options);

/// Returns the cost per band of a squared error of a profile times its factor: cost_l (2l + 1) / 4π.
std::array<double, kMaxLobeOrder> profile_costs(int order, const LobeFitOptions& options);

/// Returns at most options.profiles profiles. The first is the cosine lobe of an unoccluded vertex, which is
/// thus represented exactly. `areas` is [lobes]. Each profile has the size of its largest lobe, so that
/// factors are in 0..1.
std::vector<LobeProfile> shared_profiles(int order, std::span<const Lobe> lobes, std::span<const float> areas,
                                         const LobeFitOptions& options);

/// Returns the clamped-cosine profile.
LobeProfile cosine_profile(int order);

} // namespace prt
