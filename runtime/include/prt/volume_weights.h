#pragma once

// How probes around a place count: trilinear, and less where a surface stands between. The shaders have the
// same (shaders/prt_volume.glsl).

#include "prt/transfer_volume.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

/// A lit surface is looked up so many cells off it.
inline constexpr float kNormalBias = 0.25f;
/// A probe counts less from where surfaces are seen to be to a little behind them.
inline constexpr float kSightFull = 0.8f, kSightNone = 1.03f;
/// What a hidden probe counts, and less the further behind: where all are hidden, the least hidden light.
inline constexpr float kHiddenWeight = 1e-4f;
/// Of a probe inside of something, per metre.
inline constexpr float kBlindNearness = 1e18f;

/// `nearness` of a probe along -x, +x, -y, .., seen from which the place is at `from`.
inline float sight_weight(const std::array<float, 6>& nearness, const glm::vec3& from) {
    float passed = 0; // 1: a surface is there
    for (int a = 0; a < 3; ++a)
        passed = std::max(passed, std::abs(from[a]) *
                                      nearness[static_cast<std::size_t>(2 * a + (from[a] > 0 ? 1 : 0))]);
    const float behind = std::clamp((passed - kSightFull) / (kSightNone - kSightFull), 0.0f, 1.0f);
    const float open = 1 - behind * behind * (3 - 2 * behind);
    const float beyond = std::clamp(passed, 1.0f, 16.0f), squared = beyond * beyond,
                fourth = squared * squared;
    return std::max(open, kHiddenWeight / (fourth * fourth));
}

/// The corners of the cell of `brick` that `position` lies in, with trilinear weights.
VolumeCorners corners_in(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t brick,
                         const glm::vec3& position);

} // namespace prt
