#pragma once

// Weights of the eight probes around a position: trilinear weights, reduced for each probe that a surface
// separates from the position. shaders/prt_volume.glsl uses the same weights and constants.

#include "prt/core/transfer_volume.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

/// Distance from a lit surface, along its normal, at which a volume is looked up. Unit: width of a cell of
/// the brick that contains the surface point.
inline constexpr float kNormalBias = 0.25f;
/// The visibility weight of a probe is 1 up to kVisibilityFull times the visibility distance. It falls
/// smoothly to about kHiddenWeight at kVisibilityNone times this distance.
inline constexpr float kVisibilityFull = 0.8f, kVisibilityNone = 1.03f;
/// Minimum visibility weight of a probe for points up to its visibility distance. Beyond this distance the
/// minimum is kHiddenWeight / r^8, with r the distance of the point divided by the visibility distance, at
/// most 16. No visibility weight is 0. Therefore eight hidden probes still light the point, and the probes
/// with the smallest r dominate.
inline constexpr float kHiddenWeight = 1e-4f;
/// Value for 1 / visibility distance, per metre, if the distance is 0: the probe is inside geometry.
inline constexpr float kInvalidNearness = 1e18f;

/// Returns the visibility weight of a probe, above 0 and up to 1, for a point. The axis along which the
/// offset of the point is largest, relative to the visibility distance in that direction, determines the
/// weight. `from`: the point minus the position of the probe, metres. `nearness`: 1 / visibility distance of
/// the probe along -x, +x, -y, +y, -z, +z, per metre; kInvalidNearness if the distance is 0.
inline float visibility_weight(const std::array<float, 6>& nearness, const glm::vec3& from) {
    float passed = 0; // 1: at the distance of the surface
    for (int a = 0; a < 3; ++a)
        passed = std::max(passed, std::abs(from[a]) *
                                      nearness[static_cast<std::size_t>(2 * a + (from[a] > 0 ? 1 : 0))]);
    const float behind =
        std::clamp((passed - kVisibilityFull) / (kVisibilityNone - kVisibilityFull), 0.0f, 1.0f);
    const float open = 1 - behind * behind * (3 - 2 * behind);
    const float beyond = std::clamp(passed, 1.0f, 16.0f), squared = beyond * beyond,
                fourth = squared * squared;
    return std::max(open, kHiddenWeight / (fourth * fourth));
}

/// Returns the eight probes of the cell that contains `position`, with trilinear weights of sum 1; visibility
/// does not change the weights. `brick`: index into VolumeGrid::bricks. `position`: metres, relative to
/// Scene::origin like VolumeGrid::origin; a position outside the brick is moved to the nearest point of it.
/// `probes`: probes_of(grid). Corner i of the result is at (i & 1, i >> 1 & 1, i >> 2) in the cell.
VolumeCorners corners_in(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t brick,
                         const glm::vec3& position);

} // namespace prt
