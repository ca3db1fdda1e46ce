#pragma once

#include "clusters/guide_coordinates.h"
#include "metric/frame.h"
#include "prt/support/vector_lanes.h"
#include "prt/transfer_view.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Points that are worked on together: one per vector lane.
inline constexpr std::size_t kLanes = kLaneCount;
inline constexpr std::size_t kMostDimensions = kMostTransferNumbers;

/// Transfer vectors as points of the space of a frame, laid out for vector units: blocks of kLanes points, in
/// each block coordinate by coordinate, and then its guides. The last block is filled up with copies of its
/// first point. Floats, or whole numbers of 16 bits in steps that suit kStepBlocks blocks each.
struct PointBlocks {
    static constexpr std::size_t kStepBlocks = 64;

    std::size_t count = 0, dimension = 0, guides = 0;
    std::vector<float> values;         ///< [blocks][width][kLanes]; nothing where they are rounded
    std::vector<std::int16_t> rounded; ///< the same over their steps
    std::vector<float> steps;          ///< [blocks / kStepBlocks, rounded up][width]

    PointBlocks() = default;
    /// Rounded where the mean squared error of that is at most `most_rounding`.
    PointBlocks(const TransferView& transfer, const Frame& frame, const GuideCoordinates& guides, int threads,
                double most_rounding = 0);

    /// The mean squared error of rounding; 0 where they are floats.
    double rounding() const;
    /// Numbers of a point.
    std::size_t width() const { return dimension + guides; }
    std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
    /// [width][kLanes], in `room` for as many where it does not stand in memory like that.
    const float* block(std::size_t b, float* room) const;
    float coordinate(std::size_t point, std::size_t i) const {
        const std::size_t at = (point / kLanes * width() + i) * kLanes + point % kLanes;
        return rounded.empty() ? values[at] : static_cast<float>(rounded[at]) * steps_of(point / kLanes)[i];
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

private:
    const float* steps_of(std::size_t block) const { return steps.data() + block / kStepBlocks * width(); }
    /// All blocks, kStepBlocks at a time: `take(first_block, numbers)`, numbers as they stand in a block.
    template <class Take>
    void project(const TransferView& transfer, const Frame& frame, const GuideCoordinates& coordinates,
                 int threads, Take&& take) const;
    void round_blocks(std::size_t first, std::span<const float> numbers);
};

/// sum_p significance[p] errors[p], in a fixed order.
double total_error(std::span<const float> significance, std::span<const float> errors);

} // namespace prt
