#pragma once

#include "clusters/guide_coordinates.h"
#include "metric/frame.h"
#include "prt/support/vector_lanes.h"
#include "prt/transfer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Points that are worked on together: one per vector lane.
inline constexpr std::size_t kLanes = kLaneCount;
inline constexpr std::size_t kMostDimensions = kMostTransferNumbers;

/// Transfer vectors as points of the space of a frame, laid out for vector units: blocks of kLanes points, in
/// each block coordinate by coordinate, and then its guides. The last block is filled up with copies of its
/// first point.
struct PointBlocks {
    std::size_t count = 0, dimension = 0, guides = 0;
    std::vector<float> values; ///< [blocks][width][kLanes]

    PointBlocks() = default;
    PointBlocks(const Transfer& transfer, const Frame& frame, const GuideCoordinates& guides, int threads);

    /// Numbers of a point.
    std::size_t width() const { return dimension + guides; }
    std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
    const float* block(std::size_t b) const { return values.data() + b * width() * kLanes; }
    float coordinate(std::size_t point, std::size_t i) const {
        return values[(point / kLanes * width() + i) * kLanes + point % kLanes];
    }
    /// Copies points side by side, [width][kLanes], at most kLanes of them and at least one, which fills what
    /// is left.
    void gather(std::span<const std::uint32_t> points, float* to) const;
    /// Multiplies the guides by `scales` [guides].
    void scale_guides(std::span<const float> scales);
    /// Coordinates and guides, [width].
    void copy_point(std::size_t point, float* to) const {
        for (std::size_t i = 0; i < width(); ++i)
            to[i] = coordinate(point, i);
    }
};

/// sum_p significance[p] errors[p], in a fixed order.
double total_error(std::span<const float> significance, std::span<const float> errors);

} // namespace prt
