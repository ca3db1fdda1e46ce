// Reference methods: SH of fewer bands, and clustered PCA as published (Sloan, Hall, Hart and Snyder 2003)
// and as stored by D3DX.

#include "compress/study/baselines.h"

#include "compress/clusters/clustering.h"
#include "compress/metric/significance.h"
#include "prt/compress/light_metric.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

float snorm8(float value, float largest) {
    return largest > 0 ? std::round(std::clamp(value / largest, -1.0f, 1.0f) * 127) / 127 * largest : 0;
}

float as_float16(double value) {
    return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value)));
}

/// Returns the rows of a cluster in the space of transfer: the mean and the used directions.
std::vector<std::vector<float>> float16_rows(const Frame& frame, const ClusterFit& fit) {
    std::vector<std::vector<float>> rows;
    for (std::size_t r = 0; r <= fit.plan.bits.size(); ++r) {
        const float* from = r == 0 ? fit.mean.data() : &fit.directions[(r - 1) * frame.dimension];
        std::vector<float> row(frame.full());
        for (std::size_t a = 0; a < frame.full(); ++a) {
            double value = r == 0 ? frame.origin[a] : 0;
            for (std::size_t i = 0; i < frame.dimension; ++i)
                value += frame.synthesis[i * frame.full() + a] * static_cast<double>(from[i]);
            row[a] = as_float16(r == 0 ? value : value * frame.scale); // directions of length 1
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

/// Returns the published schedule: all components at once, rounds until convergence or none, no moves.
ClusteringSchedule classic_schedule(bool iterate) {
    return {.grow = false,
            .max_rounds = iterate ? tuning::kMaxRounds : 1,
            .tolerance = 1e-4,
            .max_move_sweeps = 0};
}

/// Clusters in the space of transfer as float16, and weights before rounding.
struct ClassicCode {
    std::vector<std::uint32_t> clusters;               ///< [receivers]
    std::vector<std::vector<std::vector<float>>> rows; ///< [clusters]: mean and directions
    std::vector<std::vector<float>> largest;           ///< [clusters][directions] largest weight
    std::size_t row_count = 0, most = 0;
    std::vector<float> weights; ///< [receivers][most]
};

ClassicCode classic_code(const Transfer& transfer, const Frame& frame, const Clustering& found) {
    ClassicCode code{found.clusters, {}, {}, 0, 0, {}};
    for (const ClusterFit& fit : found.fits) {
        code.rows.push_back(float16_rows(frame, fit));
        code.largest.emplace_back(fit.plan.bits.size(), 0.0f);
        code.row_count += code.rows.back().size();
        code.most = std::max(code.most, fit.plan.bits.size());
    }
    code.weights.resize(transfer.receivers() * code.most);
    std::vector<float> offset(transfer.dimension());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const auto& rows = code.rows[code.clusters[p]];
        for (std::size_t i = 0; i < offset.size(); ++i)
            offset[i] = transfer.vector(p)[i] - rows[0][i];
        for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
            float& weight = code.weights[p * code.most + j];
            float& largest = code.largest[code.clusters[p]][j];
            weight = dot(offset, rows[j + 1]);
            largest = std::max(largest, std::abs(weight));
        }
    }
    return code;
}

} // namespace

double bound_bytes(std::size_t bytes) {
    const std::size_t words = (bytes + 3) / 4;
    return 4 * static_cast<double>(words);
}

BaselineResult truncated_sh(const Transfer& transfer, int bands) {
    BaselineResult result;
    result.decoded = zero_transfer(transfer.layout, transfer.receivers());
    std::vector<bool> keeps;
    std::size_t columns = 0; // number of kept columns
    for (const TransferTerm& term : transfer.layout.terms) {
        const std::size_t count = transfer.layout.columns_of(term),
                          kept = std::min(count, static_cast<std::size_t>(coefficient_count(bands)));
        for (std::size_t i = 0; i < transfer.layout.numbers_of(term); ++i)
            keeps.push_back(i % count < kept);
        columns += kept;
    }
    std::vector<float> largest(transfer.dimension(), 0);
    for (std::size_t p = 0; p < transfer.receivers(); ++p)
        for (std::size_t i = 0; i < transfer.dimension(); ++i)
            largest[i] = std::max(largest[i], std::abs(transfer.vector(p)[i]));
    for (std::size_t p = 0; p < transfer.receivers(); ++p)
        for (std::size_t i = 0; i < transfer.dimension(); ++i)
            if (keeps[i])
                result.decoded.vector(p)[i] = snorm8(transfer.vector(p)[i], largest[i]);
    const auto bytes = static_cast<std::size_t>(std::count(keeps.begin(), keeps.end(), true));
    result.payload_bytes = bound_bytes(bytes);
    result.table_bytes = static_cast<double>(bytes * sizeof(float));
    // A color times a number, or each channel separately: both cost one multiply-add of a color.
    result.mean_components = static_cast<double>(columns);
    return result;
}

BaselineResult classic_cpca(const Transfer& transfer, std::span<const float> areas,
                            const ClassicOptions& options, const Progress& progress) {
    const std::vector<float> significance = significance_of(areas);
    const Frame frame = fit_frame(transfer, significance, plain_metric(transfer.layout), 0, options.threads);
    std::mt19937_64 random(options.seed);
    const ClusteringOptions how{.clusters = static_cast<std::size_t>(options.clusters),
                                .rate_budget = {.component_limit = options.components},
                                .schedule = classic_schedule(options.iterate),
                                .trace = {},
                                .threads = options.threads};
    const ClassicCode code = classic_code(transfer, frame,
                                          cluster_points(PointBlocks(transfer, frame, {}, options.threads),
                                                         significance, how, random, progress));
    BaselineResult result;
    result.decoded = zero_transfer(transfer.layout, transfer.receivers());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const std::size_t k = code.clusters[p];
        const std::span<float> to = result.decoded.vector(p);
        std::copy(code.rows[k][0].begin(), code.rows[k][0].end(), to.begin());
        for (std::size_t j = 0; j + 1 < code.rows[k].size(); ++j) {
            const float w = snorm8(code.weights[p * code.most + j], code.largest[k][j]);
            for (std::size_t i = 0; i < to.size(); ++i)
                to[i] += w * code.rows[k][j + 1][i];
        }
    }
    const std::size_t clusters = code.rows.size(), index = clusters > 256 ? 2 : clusters > 1 ? 1 : 0;
    result.payload_bytes = bound_bytes(index + code.most);
    result.table_bytes = static_cast<double>(code.row_count * transfer.dimension() * 2 +
                                             (code.row_count - clusters) * sizeof(float));
    result.mean_components = static_cast<double>(code.most);
    return result;
}

} // namespace prt
