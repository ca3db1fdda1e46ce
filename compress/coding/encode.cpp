// Writes clusters and codes in file format: rows as integers over rounded axes, weights in bits; or both as
// floats (docs/format.md).

#include "compress/coding/encode.h"

#include <Eigen/Dense>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace prt {
namespace {

constexpr std::int32_t kMaxRowValue = (1 << (kMaxRowBits - 1)) - 1;

/// Returns the rows of all clusters over the axes of the frame, in units of their steps.
std::vector<std::int32_t> integer_rows(const QuantisedClusters& clusters, const RowSteps& steps,
                                       std::size_t axes) {
    std::vector<std::int32_t> values;
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        const std::vector<double> of = steps.of(k);
        for_rows(clusters, k, [&](const float* row, int factor) {
            for (std::size_t i = 0; i < axes; ++i)
                values.push_back(
                    static_cast<std::int32_t>(std::lround(static_cast<double>(row[i]) / (factor * of[i]))));
        });
    }
    return values;
}

/// Returns the exponents of the first `axes` axes in file format: empty if all are 0.
StepExponents code_exponents(const RowSteps& steps, std::size_t axes) {
    if (std::ranges::all_of(steps.exponents, [](int e) { return e == 0; }))
        return {};
    StepExponents result;
    for (const int of_group : steps.axes) {
        result.axes.push_back(std::min(of_group, static_cast<int>(axes)));
        axes -= static_cast<std::size_t>(result.axes.back());
    }
    const std::vector<std::int32_t> values(steps.exponents.begin(), steps.exponents.end());
    result.code = encode_rows(values, steps.groups());
    return result;
}

/// Returns the number of axes up to the last that any row uses.
std::size_t axes_in_use(const QuantisedClusters& clusters, const RowSteps& steps) {
    const std::vector<std::int32_t> values = integer_rows(clusters, steps, clusters.dimension);
    std::size_t used = 0;
    for (std::size_t v = 0; v < values.size(); ++v)
        if (values[v] != 0)
            used = std::max(used, v % clusters.dimension + 1);
    return used;
}

/// Returns the unit of rounding in each column: 1 for distant light; for lamps the value at which an error of
/// one unit costs the mean of distant light.
Eigen::ArrayXd units_of(const TransferLayout& layout, const Eigen::MatrixXd& moments) {
    const Eigen::ArrayXd costs = moments.diagonal();
    const auto of_output = costs.size() / static_cast<Eigen::Index>(layout.outputs);
    const auto skies = static_cast<Eigen::Index>(layout.distant_numbers());
    const double usual = skies > 0 ? costs.head(skies).mean() : costs.head(of_output).mean();
    Eigen::ArrayXd units = Eigen::ArrayXd::Ones(costs.size());
    for (Eigen::Index a = 0; a < units.size(); ++a)
        if (a % of_output >= skies && costs[a] > 0 && usual > 0)
            units[a] = static_cast<double>(static_cast<float>(std::sqrt(usual / costs[a])));
    return units;
}

/// Returns axis i times the standard deviation of the points along it, in each column's unit.
Eigen::ArrayXd deviations_along(const Frame& frame, std::size_t i, const Eigen::ArrayXd& units) {
    const auto full = static_cast<Eigen::Index>(frame.full());
    const Eigen::Map<const Eigen::ArrayXd> axis(&frame.synthesis[i * frame.full()], full);
    return std::sqrt(frame.variances[i]) * axis / units;
}

std::vector<std::int32_t> integer_axes(const Frame& frame, const Eigen::ArrayXd& units, double unit) {
    std::vector<std::int32_t> values;
    for (std::size_t i = 0; i < frame.dimension; ++i)
        for (const double v : deviations_along(frame, i, units))
            values.push_back(static_cast<std::int32_t>(std::lround(v / unit)));
    return values;
}

/// Returns the number of axes up to the last nonzero one. Axes with 1e-10 times the deviation of the largest
/// become zero.
std::size_t axes_left(std::span<const std::int32_t> values, std::size_t full) {
    const auto last = std::find_if(values.rbegin(), values.rend(), [](std::int32_t v) { return v != 0; });
    return (static_cast<std::size_t>(values.rend() - last) + full - 1) / full;
}

ClusteredBases make_bases(const Frame& frame, const QuantisedClusters& clusters,
                          const CodedBases& coded_frame, const std::vector<Predictor>& predictors,
                          const RowSteps& steps) {
    ClusteredBases bases;
    bases.layout = frame.layout;
    bases.components = clusters.components;
    bases.predictors = predictors;
    for (std::size_t c = 0; c < clusters.clusters() * clusters.predictors; ++c)
        bases.centers.push_back(static_cast<std::int32_t>(std::lround(clusters.centers[c])));
    if (steps.least > 0) {
        const std::size_t axes = axes_in_use(clusters, steps);
        bases.coded = coded_frame;
        bases.coded.step = static_cast<float>(steps.least);
        bases.coded.exponents = code_exponents(steps, axes);
        bases.coded.scales.resize(axes);
        const std::vector<std::int32_t> all = decode_rows(coded_frame.axes, coded_frame.scales.size());
        bases.coded.axes = encode_rows(std::span(all).first(axes * frame.full()), frame.full());
        bases.coded.values = encode_rows(integer_rows(clusters, steps, axes), axes);
        bases.rows = decode_bases(bases.coded, bases.components, bases.predictor_rows());
        return bases;
    }
    const auto full = static_cast<Eigen::Index>(frame.full()),
               kept = static_cast<Eigen::Index>(frame.dimension);
    const Eigen::Map<const Eigen::MatrixXd> synthesis(frame.synthesis.data(), full, kept);
    const Eigen::Map<const Eigen::VectorXd> origin(frame.origin.data(), full);
    const auto put = [&](const float* row, bool mean) {
        Eigen::VectorXd vector = Eigen::VectorXd::Zero(full);
        if (kept > 0)
            vector = synthesis * Eigen::Map<const Eigen::VectorXf>(row, kept).cast<double>();
        if (mean)
            vector += origin;
        for (const double v : vector)
            bases.rows.push_back(static_cast<float>(v));
    };
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        put(clusters.mean(k), true);
        for (std::size_t g = 0; g < clusters.predictors; ++g)
            put(clusters.slope(k, g), false);
        for (std::size_t j = 0; j < clusters.components_of(k); ++j)
            put(clusters.row(k, j), false);
    }
    return bases;
}

void pack(const QuantisedClusters& clusters, const Codes& codes, const Encoding& encoding,
          ClusteredTransfer& result) {
    ClusteredBases& bases = result.bases;
    ClusteredReceivers& receivers = result.receivers;
    receivers.cluster_bits = encoding.cluster_bits > 0
                                 ? encoding.cluster_bits
                                 : static_cast<int>(std::bit_width(clusters.clusters() - 1));
    int most = 0;
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        int total = receivers.cluster_bits;
        for (std::size_t j = 0; j < clusters.components_of(k); ++j) {
            bases.bits.push_back(static_cast<std::uint8_t>(clusters.grid(k, j).bits()));
            total += bases.bits.back();
        }
        most = std::max(most, total);
    }
    receivers.words = std::max(1, (most + 31) / 32);
    receivers.weights.resize(codes.clusters.size() * receivers.stride());
    const std::vector<ClusterLayout> layouts = cluster_layouts(bases);
    std::vector<std::uint32_t> words(static_cast<std::size_t>(receivers.words)),
        values(clusters.max_components);
    std::vector<float> weights(clusters.max_components);
    for (std::size_t p = 0; p < codes.clusters.size(); ++p) {
        const std::uint32_t k = codes.clusters[p];
        codes.read(clusters, p, weights.data());
        for (std::size_t j = 0; j < layouts[k].components; ++j)
            values[j] = static_cast<std::uint32_t>(clusters.grid(k, j).index_of(weights[j]));
        pack_words(k, receivers.cluster_bits, layouts[k], values, words);
        std::memcpy(&receivers.weights[p * receivers.stride()], words.data(), receivers.stride());
    }
}

} // namespace

CodedBases code_frame(Frame& frame, const LightMetric& metric, double error_limit) {
    const auto full = static_cast<Eigen::Index>(frame.full());
    const Eigen::MatrixXd moments =
        frame.scale * frame.scale * Eigen::Map<const Eigen::MatrixXd>(metric.moments.data(), full, full);

    // Rounding every value of every axis to `unit` times its column's unit adds axes · cost of a unit · unit²
    // / 12.
    const Eigen::ArrayXd units = units_of(frame.layout, moments);
    const double cost = (moments.diagonal().array() * units.square()).sum();
    double unit =
        std::sqrt(12 * error_limit / (static_cast<double>(std::max<std::size_t>(frame.dimension, 1)) * cost));
    double largest = 0;
    for (std::size_t i = 0; i < frame.dimension; ++i)
        largest = std::max(largest, deviations_along(frame, i, units).abs().maxCoeff());
    unit = std::max(unit, largest / kMaxRowValue);

    CodedBases coded;
    for (double& v : frame.origin) {
        coded.origin.push_back(static_cast<float>(v));
        v = static_cast<double>(coded.origin.back());
    }
    if ((units != 1).any())
        coded.units.assign(units.begin(), units.end());
    std::vector<std::int32_t> values = integer_axes(frame, units, unit);
    truncate(frame, axes_left(values, frame.full()));
    values.resize(frame.dimension * frame.full());
    coded.axes = encode_rows(values, frame.full());
    for (std::size_t i = 0; i < frame.dimension; ++i) {
        coded.scales.push_back(static_cast<float>(unit / std::sqrt(frame.variances[i])));
        for (std::size_t a = 0; a < frame.full(); ++a)
            frame.synthesis[i * frame.full() + a] = static_cast<double>(coded.scales[i]) *
                                                    values[i * frame.full() + a] *
                                                    units[static_cast<Eigen::Index>(a)];
    }
    const auto kept = static_cast<Eigen::Index>(frame.dimension);
    if (kept == 0) // all receivers are equal
        return coded;
    // Coordinates over the rounded axes are the nearest ones in the metric.
    const Eigen::Map<const Eigen::MatrixXd> axes(frame.synthesis.data(), full, kept);
    Eigen::Map<Eigen::MatrixXd>(frame.analysis.data(), full, kept) =
        (axes.transpose() * moments * axes).ldlt().solve(axes.transpose() * moments).transpose();
    return coded;
}

ClusteredTransfer encode(const Frame& frame, const CodedBases& coded_frame, const QuantisedClusters& clusters,
                         const Codes& codes, const PredictorCoordinates& predictors,
                         const Encoding& encoding) {
    ClusteredTransfer result;
    result.bases = make_bases(frame, clusters, coded_frame, predictors.predictors, encoding.steps);
    ClusteredReceivers& receivers = result.receivers;
    receivers.predictors.resize(codes.clusters.size() * predictors.count());
    for (std::size_t at = 0; at < receivers.predictors.size(); ++at)
        receivers.predictors[at] = predictors.value(at / predictors.count(), at % predictors.count());
    receivers.format = encoding.format;
    if (encoding.format == WeightFormat::packed) {
        pack(clusters, codes, encoding, result);
        return result;
    }
    receivers.clusters.assign(codes.clusters.begin(), codes.clusters.end());
    receivers.components = (result.bases.max_components() + 3) / 4 * 4;
    const std::size_t stride = receivers.stride();
    receivers.weights.assign(codes.clusters.size() * stride, std::byte{0});
    std::vector<float> weights(clusters.max_components);
    for (std::size_t p = 0; p < codes.clusters.size(); ++p) {
        codes.read(clusters, p, weights.data());
        const auto used = std::span(weights).first(clusters.components_of(codes.clusters[p]));
        std::ranges::copy(std::as_bytes(used),
                          receivers.weights.begin() + static_cast<std::ptrdiff_t>(p * stride));
    }
    return result;
}

} // namespace prt
