#include "prt/baselines.h"

#include "clusters/clustering.h"
#include "metric/receiver_weights.h"
#include "prt/light_metric.h"
#include "prt/sh.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

float snorm8(float value, float largest) {
    return largest > 0 ? std::round(std::clamp(value / largest, -1.0f, 1.0f) * 127) / 127 * largest : 0;
}

float as_half(double value) {
    return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value)));
}

/// Rows of a cluster in the space of transfer: the mean and the directions that are in use.
std::vector<std::vector<float>> half_rows(const Frame& frame, const ClusterFit& fit) {
    std::vector<std::vector<float>> rows;
    for (std::size_t r = 0; r <= fit.plan.bits.size(); ++r) {
        const float* from = r == 0 ? fit.mean.data() : &fit.directions[(r - 1) * frame.dimension];
        std::vector<float> row(frame.full());
        for (std::size_t a = 0; a < frame.full(); ++a) {
            double value = r == 0 ? frame.origin[a] : 0;
            for (std::size_t i = 0; i < frame.dimension; ++i)
                value += frame.synthesis[i * frame.full() + a] * static_cast<double>(from[i]);
            row[a] = as_half(r == 0 ? value : value * frame.scale); // directions of length 1
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

float dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return static_cast<float>(sum);
}

} // namespace

double bound_bytes(std::size_t bytes) {
    return static_cast<double>((bytes + 3) / 4 * 4);
}

BaselineResult truncated_sh(const Transfer& transfer, int bands) {
    BaselineResult result;
    result.decoded = zero_transfer(transfer.order, transfer.channels, transfer.receivers());
    const auto count = static_cast<std::size_t>(coefficient_count(transfer.order)),
               kept = static_cast<std::size_t>(coefficient_count(bands));
    std::vector<float> largest(transfer.dimension(), 0);
    for (std::size_t p = 0; p < transfer.receivers(); ++p)
        for (std::size_t i = 0; i < transfer.dimension(); ++i)
            largest[i] = std::max(largest[i], std::abs(transfer.vector(p)[i]));
    for (std::size_t p = 0; p < transfer.receivers(); ++p)
        for (std::size_t i = 0; i < transfer.dimension(); ++i)
            if (i % count < kept)
                result.decoded.vector(p)[i] = snorm8(transfer.vector(p)[i], largest[i]);
    const std::size_t bytes = kept * static_cast<std::size_t>(transfer.channels);
    result.payload_bytes = bound_bytes(bytes);
    result.table_bytes = static_cast<double>(bytes * sizeof(float));
    // A colour times a number, or each channel by itself: the cost of one multiply-add of a colour.
    result.shader_ops = static_cast<double>(kept);
    return result;
}

BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress) {
    const std::vector<float> weights = receiver_weights(areas);
    const Frame frame =
        fit_frame(transfer, weights, plain_metric(transfer.order, transfer.channels), 0, options.threads);
    const PointBlocks points(transfer, frame, options.threads);
    ClusteringOptions how;
    how.clusters = static_cast<std::size_t>(options.clusters);
    how.spending.most_components = options.components;
    how.grow = false;
    how.most_moves = 0;
    how.most_rounds = options.iterate ? 200 : 1;
    how.tolerance = 1e-4;
    how.threads = options.threads;
    std::mt19937_64 random(options.seed);
    const Clustering found = cluster_points(points, weights, how, random, progress);

    std::vector<std::vector<std::vector<float>>> rows;
    std::vector<std::vector<float>> largest;
    std::size_t row_count = 0, most = 0;
    for (const ClusterFit& fit : found.fits) {
        rows.push_back(half_rows(frame, fit));
        largest.emplace_back(fit.plan.bits.size(), 0.0f);
        row_count += rows.back().size();
        most = std::max(most, fit.plan.bits.size());
    }
    std::vector<float> coded(transfer.receivers() * most, 0), offset(transfer.dimension());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const std::size_t k = found.clusters[p];
        for (std::size_t i = 0; i < offset.size(); ++i)
            offset[i] = transfer.vector(p)[i] - rows[k][0][i];
        for (std::size_t j = 0; j + 1 < rows[k].size(); ++j) {
            coded[p * most + j] = dot(offset, rows[k][j + 1]);
            largest[k][j] = std::max(largest[k][j], std::abs(coded[p * most + j]));
        }
    }
    BaselineResult result;
    result.decoded = zero_transfer(transfer.order, transfer.channels, transfer.receivers());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const std::size_t k = found.clusters[p];
        const std::span<float> to = result.decoded.vector(p);
        std::copy(rows[k][0].begin(), rows[k][0].end(), to.begin());
        for (std::size_t j = 0; j + 1 < rows[k].size(); ++j) {
            const float w = snorm8(coded[p * most + j], largest[k][j]);
            for (std::size_t i = 0; i < to.size(); ++i)
                to[i] += w * rows[k][j + 1][i];
        }
    }
    const std::size_t index = found.fits.size() > 256 ? 2 : found.fits.size() > 1 ? 1 : 0;
    result.payload_bytes = bound_bytes(index + most);
    result.table_bytes = static_cast<double>(row_count * transfer.dimension() * 2 +
                                             (row_count - found.fits.size()) * sizeof(float));
    result.shader_ops = static_cast<double>(most);
    return result;
}

} // namespace prt
