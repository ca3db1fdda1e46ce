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

/// How much errors of each point count along groups of axes: an error of light is seen against the light
/// that is there (docs/math.md, eq. 29). Without groups all count alike.
struct PointScales {
    std::vector<std::uint8_t> group_of; ///< [axes]
    std::vector<float> scales;          ///< [points][groups] of distances
    std::size_t groups = 0;

    bool all_alike() const { return groups == 0; }
    std::span<const float> of(std::size_t point) const {
        return std::span(scales).subspan(point * groups, groups);
    }
    /// Side by side, [groups][kLanes], at most kLanes and at least one, which fills what is left.
    void gather(std::span<const std::uint32_t> points, float* to) const;
    /// Multiplies `vector` [axes] by the scales of `point`.
    void multiply(std::size_t point, float* vector) const {
        for (std::size_t i = 0; i < (groups > 0 ? group_of.size() : 0); ++i)
            vector[i] *= scales[point * groups + group_of[i]];
    }
};

/// Transfer vectors as points of the space of a frame, laid out for vector units: blocks of kLanes points, in
/// each block coordinate by coordinate, and then its guides. The last block is filled up with copies of its
/// first point. Floats, or whole numbers of 16 bits in steps that suit kStepBlocks blocks each.
struct PointBlocks {
    static constexpr std::size_t kStepBlocks = 64;

    std::size_t count = 0, dimension = 0, guides = 0;
    std::vector<float> values;         ///< [blocks][width][kLanes]; nothing where they are rounded
    std::vector<std::int16_t> rounded; ///< the same over their steps
    std::vector<float> steps;          ///< [blocks / kStepBlocks, rounded up][width]
    PointScales scales;

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
    /// Multiplies the guides by `factors` [guides].
    void scale_guides(std::span<const float> factors);
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
