#pragma once

// Transfer vectors as points for clustering.

#include "compress/clusters/predictor_coordinates.h"
#include "compress/metric/frame.h"
#include "compress/metric/point_scales.h"
#include "prt/core/transfer_view.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

inline constexpr std::size_t kMaxDimensions = kMaxTransferNumbers;

/// Transfer vectors as points in the space of a frame, in a SIMD layout: blocks of kLanes points, each block
/// coordinate by coordinate, followed by its predictors. The last block is padded with copies of its first
/// point. Stored as floats, or as 16-bit integers with steps for each kStepBlocks blocks.
struct PointBlocks {
    static constexpr std::size_t kStepBlocks = 64;

    std::size_t count = 0, dimension = 0, predictors = 0;
    std::vector<float> values;         ///< [blocks][width][kLanes]; empty if rounded
    std::vector<std::int16_t> rounded; ///< [blocks][width][kLanes] in units of their steps
    std::vector<float> steps;          ///< [blocks / kStepBlocks, rounded up][width]
    PointScales scales;

    PointBlocks() = default;
    /// Rounds the points if the mean squared error of rounding is at most `max_rounding`.
    PointBlocks(const TransferView& transfer, const Frame& frame, const PredictorCoordinates& predictors,
                int threads, double max_rounding = 0);

    /// Returns the mean squared error of rounding; 0 for floats.
    double rounding() const;
    /// Number of values per point.
    std::size_t width() const { return dimension + predictors; }
    std::size_t blocks() const { return (count + kLanes - 1) / kLanes; }
    /// Returns block `b`, [width][kLanes]; uses the buffer `room` if it must be converted.
    const float* block(std::size_t b, float* room) const;
    float coordinate(std::size_t point, std::size_t i) const {
        const std::size_t at = (point / kLanes * width() + i) * kLanes + point % kLanes;
        return rounded.empty() ? values[at] : static_cast<float>(rounded[at]) * steps_of(point / kLanes)[i];
    }
    /// Copies at least one and at most kLanes points to [width][kLanes]; the first point fills the remaining
    /// lanes.
    void gather(std::span<const std::uint32_t> points, float* to) const;
    /// Multiplies the predictors by `factors` [predictors].
    void scale_predictors(std::span<const float> factors);
    /// Copies coordinates and predictors, [width].
    void copy_point(std::size_t point, float* to) const {
        for (std::size_t i = 0; i < width(); ++i)
            to[i] = coordinate(point, i);
    }

private:
    const float* steps_of(std::size_t block) const { return steps.data() + block / kStepBlocks * width(); }
    /// Projects all blocks, kStepBlocks at a time: `take(first_block, numbers)`, with numbers in block
    /// layout.
    template <class Take>
    void project(const TransferView& transfer, const Frame& frame, const PredictorCoordinates& coordinates,
                 int threads, Take&& take) const;
    void round_blocks(std::size_t first, std::span<const float> numbers);
};

/// Returns sum_p significance[p] errors[p], in a fixed order.
double total_error(std::span<const float> significance, std::span<const float> errors);

} // namespace prt
