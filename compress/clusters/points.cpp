// Projects transfer vectors into the space of a frame (docs/math.md, section 4) in a SIMD layout.

#include "compress/clusters/points.h"

#include "compress/metric/transfer_columns.h"
#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace prt {

namespace {

constexpr float kMaxStep = 32767;

PRT_TARGET_CLONES
void multiply_steps(const std::int16_t* from, const float* steps, std::size_t width, float* to) {
    for (std::size_t i = 0; i < width; ++i)
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            to[i * kLanes + lane] = static_cast<float>(from[i * kLanes + lane]) * steps[i];
}

} // namespace

template <class Take>
void PointBlocks::project(const TransferView& transfer, const Frame& frame,
                          const PredictorCoordinates& coordinates, int threads, Take&& take) const {
    const auto full = static_cast<Eigen::Index>(frame.full()), kept = static_cast<Eigen::Index>(dimension),
               lanes = static_cast<Eigen::Index>(kLanes);
    const Eigen::Map<const Eigen::MatrixXd> analysis(frame.analysis.data(), full, kept);
    const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
    parallel_for(blocks(), kStepBlocks, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> numbers((end - begin) * width() * kLanes);
        Eigen::MatrixXd vectors(full, lanes);
        for (std::size_t b = begin; b < end; ++b) {
            float* to = &numbers[(b - begin) * width() * kLanes];
            const Eigen::MatrixXf read = columns_of(transfer, b * kLanes, std::min((b + 1) * kLanes, count));
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const std::size_t from = static_cast<Eigen::Index>(lane) < read.cols() ? lane : 0;
                for (std::size_t g = 0; g < predictors; ++g)
                    to[(dimension + g) * kLanes + lane] = coordinates.scaled(b * kLanes + from, g);
                vectors.col(static_cast<Eigen::Index>(lane)) =
                    read.col(static_cast<Eigen::Index>(from)).cast<double>() - origin;
            }
            Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
                to, kept, lanes) = (analysis.transpose() * vectors).cast<float>();
        }
        take(begin, std::span<const float>(numbers));
    });
}

PointBlocks::PointBlocks(const TransferView& transfer, const Frame& frame,
                         const PredictorCoordinates& coordinates, int threads, double max_rounding)
    : count(transfer.receivers()), dimension(frame.dimension), predictors(coordinates.count()) {
    assert(dimension <= kMaxDimensions); // size of the kernels' arrays
    if (width() == 0)                    // all receivers are equal
        return;
    const std::size_t numbers = blocks() * width() * kLanes;
    if (max_rounding > 0) {
        rounded.resize(numbers);
        steps.resize((blocks() + kStepBlocks - 1) / kStepBlocks * width());
        project(transfer, frame, coordinates, threads,
                [&](std::size_t first, std::span<const float> of) { round_blocks(first, of); });
        if (rounding() <= max_rounding)
            return;
        rounded = {};
        steps = {};
    }
    values.resize(numbers);
    project(transfer, frame, coordinates, threads, [&](std::size_t first, std::span<const float> of) {
        std::ranges::copy(of, values.begin() + static_cast<std::ptrdiff_t>(first * width() * kLanes));
    });
}

void PointBlocks::round_blocks(std::size_t first, std::span<const float> numbers) {
    float* step = steps.data() + first / kStepBlocks * width();
    for (std::size_t at = 0; at < numbers.size(); ++at) {
        float& largest = step[at / kLanes % width()];
        largest = std::max(largest, std::abs(numbers[at]));
    }
    for (std::size_t i = 0; i < width(); ++i)
        step[i] /= kMaxStep;
    std::int16_t* to = rounded.data() + first * width() * kLanes;
    for (std::size_t at = 0; at < numbers.size(); ++at) {
        const float of = step[at / kLanes % width()];
        to[at] = static_cast<std::int16_t>(of > 0 ? std::lround(numbers[at] / of) : 0);
    }
}

/// Errors are uniform over a step: the variance is its square over 12.
double PointBlocks::rounding() const {
    double sum = 0;
    for (std::size_t at = 0; at < steps.size(); ++at)
        if (at % width() < dimension)
            sum += static_cast<double>(steps[at]) * static_cast<double>(steps[at]) / 12;
    return steps.empty() ? 0 : sum * static_cast<double>(width()) / static_cast<double>(steps.size());
}

const float* PointBlocks::block(std::size_t b, float* room) const {
    const std::size_t first = b * width() * kLanes;
    if (rounded.empty())
        return values.data() + first;
    multiply_steps(rounded.data() + first, steps_of(b), width(), room);
    return room;
}

void PointBlocks::gather(std::span<const std::uint32_t> points, float* to) const {
    for (std::size_t lane = 0; lane < kLanes && width() > 0; ++lane) {
        const std::uint32_t p = points[lane < points.size() ? lane : 0];
        const std::size_t first = p / kLanes * width() * kLanes + p % kLanes;
        if (rounded.empty()) {
            for (std::size_t i = 0; i < width(); ++i)
                to[i * kLanes + lane] = values[first + i * kLanes];
            continue;
        }
        const float* step = steps_of(p / kLanes);
        for (std::size_t i = 0; i < width(); ++i)
            to[i * kLanes + lane] = static_cast<float>(rounded[first + i * kLanes]) * step[i];
    }
}

void PointBlocks::scale_predictors(std::span<const float> factors) {
    if (!rounded.empty()) {
        for (std::size_t at = 0; at < steps.size(); ++at)
            if (const std::size_t i = at % width(); i >= dimension)
                steps[at] *= factors[i - dimension];
        return;
    }
    for (std::size_t b = 0; b < blocks(); ++b)
        for (std::size_t g = 0; g < predictors; ++g)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                values[(b * width() + dimension + g) * kLanes + lane] *= factors[g];
}

double total_error(std::span<const float> significance, std::span<const float> errors) {
    double total = 0;
    for (std::size_t p = 0; p < errors.size(); ++p)
        total += static_cast<double>(significance[p]) * static_cast<double>(errors[p]);
    return total;
}

} // namespace prt
