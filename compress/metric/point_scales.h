#pragma once

// Weights of errors, for each point of the clustering.

#include "runtime/core/support/vector_lanes.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Number of points processed together: one per SIMD lane.
inline constexpr std::size_t kLanes = kLaneCount;

/// Weights of each point's errors along groups of axes: an error of light is relative to the local light
/// (docs/math.md, eq. 29). Without groups all weights are equal.
struct PointScales {
    std::vector<std::uint8_t> group_of; ///< [axes]
    std::vector<float> scales;          ///< [points][groups] scales of distances
    std::size_t groups = 0;

    bool all_alike() const { return groups == 0; }
    std::span<const float> of(std::size_t point) const {
        return std::span(scales).subspan(point * groups, groups);
    }
    /// Copies the scales of at least one and at most kLanes points to [groups][kLanes]; the first point fills
    /// the remaining lanes.
    void gather(std::span<const std::uint32_t> points, float* to) const;
    /// Multiplies `vector` [axes] by the scales of `point`.
    void multiply(std::size_t point, float* vector) const {
        for (std::size_t i = 0; i < (groups > 0 ? group_of.size() : 0); ++i)
            vector[i] *= scales[point * groups + group_of[i]];
    }
};

} // namespace prt
