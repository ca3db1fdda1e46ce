// Takes transfer vectors into the space of a frame (docs/math.md, section 4) and lays them out for vector
// units.

#include "clusters/points.h"

#include "prt/support/parallel.h"

#include <Eigen/Dense>

#include <cassert>

namespace prt {

PointBlocks::PointBlocks(const Transfer& transfer, const Frame& frame, const GuideCoordinates& coordinates,
                         int threads)
    : count(transfer.receivers()), dimension(frame.dimension), guides(coordinates.count()) {
    assert(dimension <= kMostDimensions); // arrays of the kernels have so many
    if (width() == 0)                     // all receivers alike
        return;
    values.resize(blocks() * width() * kLanes);
    parallel_for(blocks(), 64, threads, [&](std::size_t begin, std::size_t end) {
        const auto full = static_cast<Eigen::Index>(frame.full()),
                   kept = static_cast<Eigen::Index>(dimension);
        const Eigen::Map<const Eigen::MatrixXd> analysis(frame.analysis.data(), full, kept);
        const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
        Eigen::MatrixXd vectors(full, static_cast<Eigen::Index>(kLanes));
        for (std::size_t b = begin; b < end; ++b) {
            float* to = values.data() + b * width() * kLanes;
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const std::size_t p = b * kLanes + lane < count ? b * kLanes + lane : b * kLanes;
                for (std::size_t g = 0; g < guides; ++g)
                    to[(dimension + g) * kLanes + lane] = coordinates.scaled(p, g);
                const Eigen::Map<const Eigen::VectorXf> vector(transfer.vector(p).data(), full);
                vectors.col(static_cast<Eigen::Index>(lane)) = vector.cast<double>() - origin;
            }
            Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
                to, kept, static_cast<Eigen::Index>(kLanes)) = (analysis.transpose() * vectors).cast<float>();
        }
    });
}

void PointBlocks::gather(std::span<const std::uint32_t> points, float* to) const {
    if (width() == 0)
        return;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t p = points[lane < points.size() ? lane : 0];
        const float* from = block(p / kLanes) + p % kLanes;
        for (std::size_t i = 0; i < width(); ++i)
            to[i * kLanes + lane] = from[i * kLanes];
    }
}

void PointBlocks::scale_guides(std::span<const float> scales) {
    for (std::size_t b = 0; b < blocks(); ++b)
        for (std::size_t g = 0; g < guides; ++g)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                values[(b * width() + dimension + g) * kLanes + lane] *= scales[g];
}

double total_error(std::span<const float> significance, std::span<const float> errors) {
    double total = 0;
    for (std::size_t p = 0; p < errors.size(); ++p)
        total += static_cast<double>(significance[p]) * static_cast<double>(errors[p]);
    return total;
}

} // namespace prt
