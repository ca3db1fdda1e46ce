#include "prt/compress.h"

#include "clusters/clustering.h"
#include "coding/encode.h"
#include "coding/seams.h"
#include "metric/receiver_weights.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace prt {
namespace {

[[noreturn]] void out_of_range(const std::string& what, double value) {
    std::string number = std::to_string(value);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.')
        number.pop_back();
    throw Error(what + ", not " + number);
}

void check(const Transfer& transfer, std::span<const float> areas, const CompressOptions& o) {
    check_order(transfer.order);
    if (o.clusters < 1 || o.clusters > 65536)
        out_of_range("clusters must lie in 1..65536", o.clusters);
    if (o.components < 0)
        out_of_range("components must not be negative", o.components);
    if (!(o.mean_components >= 0))
        out_of_range("components per vertex must not be negative", o.mean_components);
    if (o.weights == WeightFormat::packed) {
        if (o.fixed_bits.empty() && (o.bits < 0 || o.bits > kMostPackedBits))
            out_of_range("bits of a vertex's weights must lie in 0.." + std::to_string(kMostPackedBits),
                         o.bits);
        for (const int bits : o.fixed_bits)
            if (bits < 1 || bits > kMostBits)
                out_of_range("bits of a weight must lie in 1.." + std::to_string(kMostBits), bits);
        if (o.cluster_bits < 0 || o.cluster_bits > 16 ||
            (o.cluster_bits > 0 && o.clusters > 1 << o.cluster_bits))
            throw Error(std::to_string(o.clusters) + " clusters do not fit " +
                        std::to_string(o.cluster_bits) + " bits");
    }
    if (!(o.seam_weight >= 0) || !(o.potts_weight >= 0))
        out_of_range("seam weights must not be negative", std::min(o.seam_weight, o.potts_weight));
    if (o.basis_share && !(*o.basis_share >= 0 && *o.basis_share < 1))
        out_of_range("the share of the bases must lie in 0..1", *o.basis_share);
    if (o.metric && (o.metric->order != transfer.order || o.metric->channels != transfer.channels))
        throw Error("the metric has another order or other channels than the transfer");
    if (transfer.receivers() == 0)
        throw Error("there are no receivers to compress");
    if (areas.size() != transfer.receivers())
        throw Error("there are areas for " + std::to_string(areas.size()) + " receivers of " +
                    std::to_string(transfer.receivers()));
    if (!std::all_of(transfer.vectors.begin(), transfer.vectors.end(),
                     [](float v) { return std::isfinite(v); }))
        throw Error("the transfer holds values that are not finite");
}

double basis_share(const CompressOptions& o) {
    if (o.basis_share)
        return *o.basis_share;
    switch (o.weights) {
    case WeightFormat::packed:
        return 0.1;
    case WeightFormat::snorm8:
        return 0.05;
    case WeightFormat::snorm16:
        return 0.0001;
    case WeightFormat::float32:
        break;
    }
    return 0;
}

Spending spending_of(const CompressOptions& o, std::size_t dimension) {
    Spending spending;
    spending.most_components = std::min(o.components, static_cast<int>(dimension));
    if (o.weights != WeightFormat::packed)
        return spending;
    spending.most_components = std::min(spending.most_components, kMostPackedComponents);
    spending.bits = o.bits;
    spending.fixed_bits = o.fixed_bits;
    if (!o.fixed_bits.empty())
        spending.most_components = std::min(spending.most_components, static_cast<int>(o.fixed_bits.size()));
    else if (o.bits == 0)
        spending.most_components = 0;
    return spending;
}

float half_of(WeightFormat format) {
    switch (format) {
    case WeightFormat::snorm8:
        return 127;
    case WeightFormat::snorm16:
        return 32767;
    case WeightFormat::float32:
    case WeightFormat::packed:
        break;
    }
    return 0; // free, or by the bits of each cluster
}

/// Points in a frame, and the clusters found there.
struct Clustered {
    Frame frame;
    PointBlocks points;
    Clustering clustering;
};

/// Axes that carry less than a hundredth of the error that will be left are left out. That is known only
/// afterwards: a frame that turns out too coarse is made anew.
Clustered cluster(const Transfer& transfer, std::span<const float> weights, const LightMetric& metric,
                  const CompressOptions& options, const Progress& progress) {
    ClusteringOptions how;
    how.clusters = static_cast<std::size_t>(options.clusters);
    how.spending = spending_of(options, transfer.dimension());
    how.mean_components = options.mean_components;
    how.rows_cost = options.weights == WeightFormat::packed && options.bases_count;
    how.threads = options.threads;
    double most_dropped = options.weights == WeightFormat::float32 || !(basis_share(options) > 0) ? 0
                          : options.bits > 48                                                     ? 1e-7
                                                                                                  : 1e-6;
    for (;;) {
        Frame frame = fit_frame(transfer, weights, metric, most_dropped, options.threads);
        PointBlocks points(transfer, frame, options.threads);
        std::mt19937_64 random(options.seed);
        Clustering found = cluster_points(points, weights, how, random, progress);
        if (!(frame.dropped > 0.04 * found.cost) || most_dropped == 0)
            return {std::move(frame), std::move(points), std::move(found)};
        most_dropped = std::max(0.01 * found.cost, 1e-13);
        if (found.cost < 1e-11)
            most_dropped = 0;
    }
}

/// The step of the bases at which rounding adds `share` of the squared error `error`: a receiver's code is
/// the sum of its mean and of m rows times weights of mean square about 0.2, which are rounded to twice the
/// step.
double basis_step(const QuantisedModels& models, double error, double share) {
    double rows = 0, largest = 0;
    for (const int m : models.components)
        rows += 1 + 0.8 * m;
    for (const float v : models.means)
        largest = std::max(largest, static_cast<double>(std::abs(v)));
    for (const float v : models.rows)
        largest = std::max(largest, static_cast<double>(std::abs(v)) / 2);
    const double noise =
        static_cast<double>(models.dimension) * rows / static_cast<double>(models.clusters()) / 12;
    const double most = static_cast<double>(1 << (kMostRowBits - 1)) - 1;
    return std::max({noise > 0 ? std::sqrt(share * error / noise) : 0.0, largest / most, 1e-30});
}

/// The same clusters over fewer axes.
QuantisedModels truncated(const QuantisedModels& models, std::size_t dimension) {
    QuantisedModels result = models;
    result.dimension = dimension;
    const auto keep = [&](std::vector<float>& rows) {
        std::vector<float> kept;
        for (std::size_t first = 0; first < rows.size(); first += models.dimension)
            kept.insert(kept.end(), rows.begin() + static_cast<std::ptrdiff_t>(first),
                        rows.begin() + static_cast<std::ptrdiff_t>(first + dimension));
        rows = std::move(kept);
    };
    if (models.dimension > 0) {
        keep(result.means);
        keep(result.rows);
    }
    return result;
}

/// Axes without which the squared error grows by at most `most`.
std::size_t axes_needed(const Frame& frame, double most) {
    std::size_t axes = frame.dimension;
    double dropped = frame.dropped;
    while (axes > 0 && dropped + frame.variances[axes - 1] <= most)
        dropped += frame.variances[--axes];
    return axes;
}

/// Clusters without receivers take no place in the file.
void drop_empty(QuantisedModels& models, Codes& codes) {
    std::vector<std::uint32_t> new_index(models.clusters(), 0);
    for (const std::uint32_t k : codes.clusters)
        new_index[k] = 1;
    std::uint32_t kept = 0;
    for (std::size_t k = 0; k < models.clusters(); ++k) {
        if (!new_index[k])
            continue;
        std::copy_n(models.mean(k), models.dimension, models.mean(kept));
        if (models.max_components > 0) {
            std::copy_n(models.row(k, 0), models.max_components * models.dimension, models.row(kept, 0));
            std::copy_n(&models.halves[k * models.max_components], models.max_components,
                        &models.halves[kept * models.max_components]);
        }
        models.components[kept] = models.components[k];
        new_index[k] = kept++;
    }
    models.components.resize(kept);
    for (std::uint32_t& k : codes.clusters)
        k = new_index[k];
}

struct Quantised {
    QuantisedModels models;
    Codes codes;
    double step = 0;
};

/// Codes all points; where the mean number of components is promised they stay in their clusters.
void encode_all(const PointBlocks& points, const CompressOptions& options, Quantised& q) {
    constexpr std::size_t kNeighbours = 16;
    if (options.mean_components > 0)
        encode_in_place(points, q.models, q.codes, options.threads);
    else
        encode_points(points, q.models, neighbour_clusters(q.models, kNeighbours, options.threads), q.codes,
                      options.threads);
}

/// Alternates codes, given the clusters, and clusters, given the codes; from the third round on with the
/// bases rounded as they will be written. Leaves the best of the rounds that could be written.
void alternate(const PointBlocks& points, std::span<const float> weights, const CompressOptions& options,
               const Progress& progress, Quantised& q) {
    constexpr int kRounds = 6, kRoundedFrom = 2;
    if (options.weights == WeightFormat::float32)
        return;
    const bool rounded = basis_share(options) > 0;
    Quantised best;
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round) {
        progress.update(0.7 + 0.04 * round);
        refit(points, weights, q.codes, q.models, options.threads);
        if (round >= kRoundedFrom && rounded) {
            q.step = basis_step(q.models, total_error(weights, q.codes.errors), basis_share(options));
            round_rows(q.models, q.step);
        }
        const Codes before = q.codes;
        encode_all(points, options, q);
        keep_better(points, q.models, before, q.codes, options.threads);
        if (const double error = total_error(weights, q.codes.errors);
            (round >= kRoundedFrom || !rounded) && error < least) {
            least = error;
            best = q;
        }
    }
    q = std::move(best);
}

double mean_components(const ClusteredTransfer& transfer) {
    double sum = 0;
    for (const std::uint16_t k : transfer.receivers.clusters)
        sum += transfer.bases.components[k];
    return sum / static_cast<double>(transfer.receivers.size());
}

} // namespace

CompressOptions preset_u32() {
    CompressOptions options;
    options.clusters = 256;
    options.cluster_bits = 8;
    options.fixed_bits = {7, 6, 6, 5};
    options.components = 4;
    return options;
}

CompressOptions preset_u64() {
    CompressOptions options = preset_u32();
    options.fixed_bits = {9, 8, 7, 7, 6, 6, 5, 4, 4};
    options.components = 9;
    return options;
}

CompressResult compress(const Transfer& transfer, std::span<const float> areas, std::span<const Edge> edges,
                        const CompressOptions& options, const Progress& progress) {
    check(transfer, areas, options);
    const Stopwatch stopwatch;
    const std::vector<float> weights = receiver_weights(areas);
    const LightMetric metric =
        options.metric ? *options.metric : natural_metric(transfer.order, transfer.channels);

    auto found = std::make_unique<Clustered>(cluster(transfer, weights, metric, options, progress));
    CompressResult result;
    for (const double error : found->clustering.history)
        result.statistics.lit_rms_by_iteration.push_back(std::sqrt(error + found->frame.dropped));
    Quantised q;
    q.models =
        quantised_models(found->points, weights, found->clustering, options.weights == WeightFormat::float32,
                         half_of(options.weights), options.threads);
    q.codes.clusters = found->clustering.clusters;
    encode_all(found->points, options, q);

    Frame frame = std::move(found->frame);
    CodedBases coded_frame;
    const bool coded = options.weights != WeightFormat::float32 && basis_share(options) > 0;
    if (coded) {
        const double error = total_error(weights, q.codes.errors);
        truncate(frame, axes_needed(frame, 0.01 * error));
        coded_frame = code_frame(frame, metric, 0.02 * error);
        q.models = truncated(q.models, frame.dimension);
    }
    std::optional<PointBlocks> points;
    if (!coded)
        points = std::move(found->points);
    found.reset(); // the points of the one frame make room for those of the other
    if (coded) {
        points.emplace(transfer, frame, options.threads);
        encode_in_place(*points, q.models, q.codes, options.threads);
    }
    alternate(*points, weights, options, progress, q);
    if ((options.seam_weight > 0 || options.potts_weight > 0) && !edges.empty())
        smooth_seams(*points, weights, edges, q.models,
                     {options.seam_weight, options.potts_weight, options.mean_components, options.threads},
                     q.codes);
    points.reset();
    drop_empty(q.models, q.codes);
    progress.update(0.95);
    result.transfer =
        encode(frame, coded_frame, q.models, q.codes, {options.weights, options.cluster_bits, q.step});

    CompressStatistics& statistics = result.statistics;
    statistics.clusters = static_cast<int>(result.transfer.bases.clusters());
    statistics.mean_components = mean_components(result.transfer);
    statistics.bytes_per_receiver = bytes_per_receiver(result.transfer);
    statistics.bits_per_receiver = bits_per_receiver(result.transfer);
    statistics.basis_bytes = basis_bytes(result.transfer.bases);
    statistics.lit_rms =
        expected_lit_rms(transfer, decode(result.transfer, options.threads), areas, metric, options.threads);
    statistics.seconds = stopwatch.seconds();
    progress.update(1);
    return result;
}

} // namespace prt
