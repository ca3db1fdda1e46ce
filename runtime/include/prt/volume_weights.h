#pragma once

// Weights of the probes around a position: trilinear, reduced if a surface is in between. Shaders use the
// same weights (shaders/prt_volume.glsl).

#include "prt/transfer_volume.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

/// Offset of the lookup along the normal of a lit surface, in cells.
inline constexpr float kNormalBias = 0.25f;
/// Multiples of the visibility distance between which the weight of a probe falls from 1 to its minimum.
inline constexpr float kVisibilityFull = 0.8f, kVisibilityNone = 1.03f;
/// Minimum weight of a hidden probe at the visibility distance. Farther away it decreases, but never to zero,
/// so that weights never sum to zero. If all probes are hidden, the least hidden ones dominate.
inline constexpr float kHiddenWeight = 1e-4f;
/// Inverse visibility distance, per metre, of a probe inside geometry.
inline constexpr float kInvalidNearness = 1e18f;

/// Returns the visibility weight of a probe, 0..1, for a point at offset `from` from the probe, metres.
/// `nearness` is 1 / visibility distance along -x, +x, -y, +y, -z, +z, per metre.
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

/// Returns the corners of the cell of `brick` that contains `position`, with trilinear weights.
VolumeCorners corners_in(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t brick,
                         const glm::vec3& position);

} // namespace prt
