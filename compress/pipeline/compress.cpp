// The compressor: clustered principal components of transfer vectors (Sloan, Hall, Hart and Snyder 2003) in a
// space where distance is error of exit radiance, with weight quantisation inside the loop and smoothed
// seams.

#include "prt/compress/compress.h"

#include "compress/coding/alternation.h"
#include "compress/coding/encode.h"
#include "compress/coding/refit.h"
#include "compress/coding/seams.h"
#include "compress/metric/seen_light.h"
#include "compress/pipeline/compress_from.h"
#include "compress/pipeline/compress_options.h"
#include "runtime/core/support/stopwatch.h"

namespace prt {
namespace {

/// Inputs of every step of a compression.
struct Task {
    const TransferView& transfer;
    const CompressOptions& options;
    const SeenLight& light;
    const std::vector<float>& significance; ///< [receivers] `SeenLight::weights`
    PredictorCoordinates predictors;
    const TrialSettings& settings;
};

/// Points in a frame, and the clusters found for them.
struct FoundClusters {
    Frame frame;
    PredictorCoordinates predictors;
    PointBlocks points;
    Clustering clustering;
};

/// Returns the squared error that rounding points to 16 bits may add; 0 for few receivers, whose points need
/// little memory.
double rounding_allowed(const Task& task, double most) {
    return task.transfer.receivers() < tuning::kManyReceivers ? 0 : most;
}

/// Finds clusters. Axes that carry less than a hundredth of the final error are dropped. That error is known
/// only afterwards: a frame that proves too coarse is built again.
FoundClusters find_clusters(const Task& task, const Progress& progress) {
    const CompressOptions& options = task.options;
    ClusteringOptions how = clustering_options(options, task.transfer.dimension());
    how.start.assign(task.settings.start.begin(), task.settings.start.end());
    if (task.settings.draft)
        how.schedule = draft_schedule();
    double max_dropped = !bases_are_coded(options)                ? 0
                         : task.transfer.layout().outputs > 1     ? tuning::kDroppedOfOutputs
                         : options.coding.bits > tuning::kFewBits ? tuning::kDroppedOfManyBits
                                                                  : tuning::kDroppedOfFewBits;
    const std::optional<SeenLamps>& lamps = task.light.lamps();
    const TransferView transfer = lamps ? lamps->logarithmic() : task.transfer;
    const LightMetric& metric = lamps ? lamps->metric() : task.light.metric();
    for (double from = 0;;) { // a second attempt is rare
        const double to = 1 - 0.03 * (1 - from);
        FoundClusters found;
        found.frame = fit_frame(transfer, task.significance, metric, max_dropped, options.threads);
        if (found.frame.dimension > 0) // otherwise there is nothing to predict
            found.predictors = task.predictors;
        found.points = PointBlocks(transfer, found.frame, found.predictors, options.threads,
                                   rounding_allowed(task, tuning::kRoundingOverDropped * max_dropped));
        std::mt19937_64 random(options.seed);
        found.clustering =
            cluster_points(found.points, task.significance, how, random, progress.range(from, to));
        const double cost = found.clustering.cost;
        const double lost = found.frame.dropped + found.points.rounding();
        if (!(lost > tuning::kTooMuchDropped * cost) || max_dropped == 0)
            return found;
        max_dropped =
            cost < tuning::kExactError ? 0 : std::max(tuning::kDroppedAgain * cost, tuning::kMinDropped);
        from = to;
    }
}

/// Points, clusters and codes on their way to the file.
struct Coding {
    Frame frame;
    CodedBases coded_frame; ///< code of the frame, if bases are coded
    PredictorCoordinates predictors;
    PointBlocks points;
    CodedClusters coded;
};

/// Computes the first codes in the clusters that were found, in the same frame.
Coding first_codes(const Task& task, const AlternationOptions& how, FoundClusters&& found) {
    Coding coding{std::move(found.frame), {}, std::move(found.predictors), std::move(found.points), {}};
    coding.coded.clusters = quantised_clusters(coding.points, task.significance, found.clustering,
                                               task.options.coding.format, task.options.threads);
    const std::vector<float> scales = scale_predictors(found.clustering, coding.coded.clusters);
    for (std::size_t g = 0; g < scales.size(); ++g)
        coding.predictors.scale(g) *= scales[g];
    coding.points.scale_predictors(scales);
    coding.coded.codes.clusters = std::move(found.clustering.clusters);
    encode_all(coding.points, how, coding.coded);
    return coding;
}

/// Converts to the frame of the file: fewer axes, and rounded.
void round_frame(const Task& task, Coding& coding) {
    const double error = total_error(task.significance, coding.coded.codes.errors) *
                         (task.transfer.layout().outputs > 1 ? tuning::kSharesOfOutputs : 1);
    truncate(coding.frame, axes_needed(coding.frame, tuning::kAxesShare * error));
    coding.coded_frame = code_frame(coding.frame, task.light.metric(), tuning::kAxisRoundingShare * error);
    coding.coded.clusters = truncated(coding.coded.clusters, coding.frame.dimension);
    coding.points = {}; // frees the old points before the new ones are allocated
    coding.points = PointBlocks(task.transfer, coding.frame, coding.predictors, task.options.threads,
                                rounding_allowed(task, tuning::kPointsRoundingShare * error));
    encode_in_place(coding.points, coding.coded.clusters, coding.coded.codes, task.options.threads);
}

/// Converts from logarithms of lamps to light: the axes of the file, clusters of the same receivers fitted to
/// their codes, and errors weighted as seen. The neighbours of a cluster are those in the old frame.
void leave_logarithms(const Task& task, Coding& coding, ClusterLists& candidates) {
    const CompressOptions& options = task.options;
    const SeenLamps& lamps = *task.light.lamps();
    candidates = neighbours_of_codes(coding.coded.clusters, tuning::kNeighboursOfCodes, options.threads);
    const double error =
        total_error(task.significance, coding.coded.codes.errors) / (coding.frame.scale * coding.frame.scale);
    const bool coded = bases_are_coded(options);
    coding.frame = lamps.frame(coded ? tuning::kAxesShare * error : 0);
    if (coded)
        coding.coded_frame = code_frame(coding.frame, lamps.metric(), tuning::kAxisRoundingShare * error);
    coding.coded.clusters = without_rows(coding.coded.clusters, coding.frame.dimension);
    coding.points = {};
    coding.points = PointBlocks(task.transfer, coding.frame, coding.predictors, options.threads);
    coding.points.scales = lamps.scales(coding.frame, task.light.sky_costs());
    for (int round = 0; round < tuning::kRoundsFromNothing; ++round)
        refit(coding.points, task.significance, coding.coded.codes, coding.coded.clusters, options.threads);
    encode_in_place(coding.points, coding.coded.clusters, coding.coded.codes, options.threads);
}

/// Returns the clusters with receivers, sorted by the mean of their first and last receiver. Clusters of one
/// mesh are then consecutive, so that its instances need few constants (prt/core/instances.h).
std::vector<std::uint32_t> clusters_in_order(std::span<const std::uint32_t> of_receivers, std::size_t count) {
    std::vector<std::size_t> first(count), last(count);
    std::vector<std::uint32_t> order;
    for (std::size_t p = 0; p < of_receivers.size(); ++p) {
        const std::uint32_t k = of_receivers[p];
        if (last[k] == 0) {
            order.push_back(k);
            first[k] = p;
        }
        last[k] = p + 1;
    }
    std::ranges::stable_sort(order, {}, [&](std::uint32_t k) { return first[k] + last[k]; });
    return order;
}

void put_in_order(CodedClusters& coded) {
    QuantisedClusters& clusters = coded.clusters;
    Codes& codes = coded.codes;
    const std::vector<std::uint32_t> order = clusters_in_order(codes.clusters, clusters.clusters());
    const std::vector<int> exponents = coded.steps.exponents;
    const auto groups = static_cast<std::ptrdiff_t>(coded.steps.groups());
    coded.steps.exponents.clear();
    for (const std::uint32_t from : order)
        if (!exponents.empty())
            coded.steps.exponents.insert(coded.steps.exponents.end(), exponents.begin() + from * groups,
                                         exponents.begin() + (from + 1) * groups);
    const QuantisedClusters before = clusters;
    std::vector<std::uint32_t> new_index(clusters.clusters(), 0);
    for (std::uint32_t k = 0; k < order.size(); ++k) {
        const std::uint32_t from = order[k];
        copy_cluster(before, from, clusters, k);
        new_index[from] = k;
    }
    clusters.components.resize(order.size());
    for (std::uint32_t& k : codes.clusters)
        k = new_index[k];
}

/// Adds empty rows to clusters with fewer rows if all clusters share fixed bit widths: no cluster is then an
/// exception, and the shader has no loop.
void fill_up(std::span<const int> fixed_bits, QuantisedClusters& clusters, Codes& codes) {
    if (fixed_bits.empty())
        return;
    const QuantisedClusters before = clusters;
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        for (std::size_t j = clusters.components_of(k);
             j < std::min(clusters.max_components, fixed_bits.size()); ++j) {
            std::fill_n(clusters.row(k, j), clusters.dimension, 0.0f);
            clusters.grids[k * clusters.max_components + j] = WeightGrid::of_bits(fixed_bits[j]);
            clusters.components[k] = static_cast<int>(j) + 1;
        }
    CodeWeights filled(codes.clusters.size(), clusters);
    for (std::size_t p = 0; p < codes.clusters.size(); ++p) {
        std::vector<float> weights(clusters.max_components, 0.0f);
        codes.read(before, p, weights.data());
        filled.write(clusters, codes.clusters[p], p, weights.data());
    }
    codes.weights = std::move(filled);
}

/// Performs all steps from points to the contents of a file.
ClusteredTransfer code(const Task& task, const ReceiverSurface& surface, FoundClusters&& found,
                       const Progress& progress) {
    const CompressOptions& options = task.options;
    const bool draft = task.settings.draft;
    ClusterLists candidates;
    AlternationOptions how{.candidates = nullptr,
                           .stay = options.mean_components > 0,
                           .basis_share = basis_share(options),
                           .rounds = draft ? 1 : tuning::kCodingRounds,
                           .rounded_from = draft ? 0 : tuning::kRoundedFrom,
                           .trace = options.trace,
                           .threads = options.threads};
    Coding coding = first_codes(task, how, std::move(found));
    CodedClusters& coded = coding.coded;
    if (task.light.lamps()) {
        leave_logarithms(task, coding, candidates);
        how.candidates = &candidates;
        settle(coding.points, task.significance, how,
               draft ? tuning::kSettlingRoundsOfDrafts : tuning::kSettlingRounds, coded);
    } else if (bases_are_coded(options)) {
        round_frame(task, coding);
    }
    if (options.coding.format == WeightFormat::packed || task.light.lamps())
        alternate(coding.points, task.significance, how, progress.range(0, tuning::kAlternatedAt), coded);
    progress.update(tuning::kAlternatedAt);
    if (options.seam_weight > 0 && !surface.edges.empty() && !draft)
        smooth_seams(coding.points, task.significance, surface.edges, surface.jumps, coded.clusters,
                     {.seam_weight = options.seam_weight,
                      .mean_components = options.mean_components,
                      .threads = options.threads},
                     coded.codes);
    coding.points = {};
    put_in_order(coded);
    fill_up(options.coding.fixed_bits, coded.clusters, coded.codes);
    progress.update(1);
    return encode(coding.frame, coding.coded_frame, coded.clusters, coded.codes, coding.predictors,
                  {options.coding.format, options.coding.cluster_bits, coded.steps});
}

double mean_components_of(const ClusteredTransfer& transfer) {
    double sum = 0;
    for (const std::uint16_t k : transfer.receivers.cluster_indices())
        sum += transfer.bases.components[k];
    return sum / static_cast<double>(transfer.receivers.size());
}

} // namespace

CompressResult compress(const TransferView& transfer, const ReceiverSurface& surface,
                        const CompressOptions& options, const Progress& progress) {
    return compress_from({}, transfer, surface, options, progress);
}

CompressResult compress_from(const TrialSettings& settings, const TransferView& transfer,
                             const ReceiverSurface& surface, const CompressOptions& options,
                             const Progress& progress) {
    check_input(transfer, surface, options);
    const std::span<const float> areas = surface.areas;
    const Stopwatch stopwatch;
    std::optional<SeenLight> own;
    const SeenLight& light =
        settings.light ? *settings.light
                       : own.emplace(transfer, areas, metric_of(options, transfer, areas), options.threads);
    const Task task{
        transfer, options, light, light.weights(), predictor_coordinates(surface, options.predictors),
        settings};
    CompressResult result;
    CompressStatistics& statistics = result.statistics;
    FoundClusters found = find_clusters(task, progress.range(0, tuning::kClustersFoundAt));
    for (const double error : found.clustering.history)
        statistics.lit_rms_by_iteration.push_back(std::sqrt(error + found.frame.dropped));
    result.transfer = code(task, surface, std::move(found),
                           progress.range(tuning::kClustersFoundAt, tuning::kClustersCodedAt));
    statistics.clusters = static_cast<int>(result.transfer.bases.clusters());
    statistics.mean_components = mean_components_of(result.transfer);
    statistics.predictor_rows = static_cast<int>(result.transfer.bases.predictor_rows());
    statistics.bytes_per_receiver = bytes_per_receiver(result.transfer);
    statistics.bits_per_receiver = bits_per_receiver(result.transfer);
    statistics.basis_bytes = basis_bytes(result.transfer.bases);
    statistics.lit_rms = expected_lit_rms(transfer, result.transfer, areas, light.metric(), options.threads);
    if (light.lamps())
        statistics.lamp_contrast = light.lamps()->contrast(result.transfer);
    if (light.sky())
        statistics.sky_contrast = light.sky()->contrast(result.transfer);
    statistics.seconds = stopwatch.seconds();
    progress.update(1);
    return result;
}

} // namespace prt
