// Searches clusters, bits, predictors and precision for a budget (docs/math.md, section 4, "Budgets").

#include "compress/search/budget_search.h"

#include "compress/pipeline/compress_options.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

constexpr double kNothingFound = std::numeric_limits<double>::infinity();

/// Returns the number of clusters at which a straight line through both points has `value`.
double interpolated(const KnownClusters& a, const KnownClusters& b, double value) {
    return a.clusters + (b.clusters - a.clusters) * (value - a.value) / (b.value - a.value);
}

/// Returns the factor of the number of clusters that changes an error by `factor`.
double clusters_for(double factor, double exponent) {
    return std::pow(factor, -1 / exponent);
}

} // namespace

Effort effort_of_preset(const CompressStatistics& too_large) {
    return {.min_filled = tuning::kMinFilledOfPreset,
            .both_ways = tuning::kBothWaysOfPreset,
            .bytes_per_cluster =
                static_cast<double>(too_large.basis_bytes) / static_cast<double>(too_large.clusters)};
}

BudgetSearch::BudgetSearch(const SearchTask& task, const Effort& effort)
    : task_(task), budget_(task.options.budget), effort_(effort), trials_(task),
      max_clusters_(max_clusters()) {
    if (effort.bytes_per_cluster)
        trials_.expect_bytes_per_cluster(*effort.bytes_per_cluster);
}

/// Runs the search. A limit on operations already keeps components few. The first config then does not count
/// bases (`first_config`), so that components are not dropped in favour of clusters that fit anyway: 0.40
/// instead of 1.04 times the error of classic CPCA with one component, measured on a head.
SearchResult BudgetSearch::run() {
    walk(first_config());
    if (task_.few_receivers())
        vary_thoroughly();
    else
        vary();
    finish();
    if (!trials_.kept() && budget_.bytes_per_vertex && task_.options.choose_components)
        search_fewer_components();
    return trials_.take_result();
}

PayloadConfig BudgetSearch::first_config() const {
    PayloadConfig config{.payload = first_payload(),
                         .bases_count = !budget_.operations,
                         .predictors = task_.options.compress.predictors};
    if (task_.options.choose_predictors && !affordable(config.predictors))
        config.predictors = PredictorChoice::none;
    return config;
}

bool BudgetSearch::affordable(PredictorChoice predictors) const {
    return !budget_.operations || task_.components_beside(predictors) > 0;
}

int BudgetSearch::max_clusters() const {
    if (!task_.options.choose_clusters)
        return task_.options.compress.clusters;
    const std::size_t receivers = task_.transfer.receivers(),
                      enough = std::max(tuning::kAlwaysClusters, receivers / tuning::kReceiversPerCluster),
                      most = trials_.saves_bytes() || budget_.bytes_per_vertex
                                 ? 65536
                                 : tuning::kMaxClustersOfOperations;
    return static_cast<int>(std::clamp<std::size_t>(std::min(enough, receivers), 1, most));
}

int BudgetSearch::min_payload() const {
    const int given = task_.options.payload;
    return given > 0 ? given : task_.packed() ? 1 : 0;
}

int BudgetSearch::max_payload() const {
    if (task_.options.payload > 0)
        return task_.options.payload;
    int most = task_.packed() ? kMaxPackedWords : (task_.dimension() + 3) / 4;
    if (budget_.bytes_per_vertex)
        while (most > min_payload() && task_.payload_bytes(most) > *budget_.bytes_per_vertex)
            --most;
    else if (task_.packed() && budget_.operations && !trials_.saves_bytes())
        most = std::min(
            most, static_cast<int>(std::ceil(
                      (tuning::kEnoughClusterBits + tuning::kEnoughWeightBits * *budget_.operations) / 32)));
    return most;
}

double BudgetSearch::max_bytes(const PayloadConfig& config) const {
    return budget_.bytes_per_vertex.value_or((1 + tuning::kBasesOverWeights) *
                                             task_.payload_bytes(std::max(config.payload, max_payload())));
}

/// Returns the start payload. Few components need few weight bits.
int BudgetSearch::first_payload() const {
    double bytes = tuning::kFirstBytes;
    if (budget_.max_error)
        bytes += tuning::kBytesPerHalving * std::log2(tuning::kFirstBytesError / *budget_.max_error);
    if (budget_.bytes_per_vertex)
        bytes = (budget_.operations ? tuning::kWeightsShareOfFewComponents : tuning::kWeightsShare) *
                *budget_.bytes_per_vertex;
    double payload = bytes / task_.payload_bytes(1);
    if (!trials_.saves_bytes() && !budget_.bytes_per_vertex)
        payload = 0.5 * max_payload(); // each word costs a trial, and the last words save almost nothing
    return std::clamp(static_cast<int>(std::lround(payload)), min_payload(), max_payload());
}

/// Walks from the start in both directions until the cost increases twice in a row.
double BudgetSearch::walk(const PayloadConfig& start) {
    double least = best_on(start);
    for (const int direction : {1, -1}) {
        double best = best_on(start);
        int worse = 0;
        for (int payload = start.payload + direction;
             payload >= min_payload() && payload <= max_payload() && worse < tuning::kPatience;
             payload += direction) {
            if (trials_.saves_bytes() && trials_.kept() &&
                task_.payload_bytes(payload) >= trials_.best()->trial.bytes_per_vertex)
                break; // the weights alone take more
            PayloadConfig config = start;
            config.payload = payload;
            const double found = best_on(config);
            worse = found < best ? 0 : worse + 1;
            best = std::min(best, found);
        }
        least = std::min(least, best);
    }
    return least;
}

/// Tries the other value of `bases_count`: if bases outweigh weights, or operations are limited, the better
/// choice is not known in advance. Also tries other predictors: they help if their rows are small compared
/// with the weights of all receivers, but components may use the operations better.
void BudgetSearch::vary() {
    const SearchTrial& best = trials_.best()->trial;
    const bool other_way = budget_.operations ||
                           (task_.packed() && best.bytes_per_vertex > effort_.both_ways * best.payload_bytes);
    if (other_way) {
        const double found = trials_.cost(best);
        PayloadConfig config = trials_.best()->config;
        config.bases_count = !config.bases_count;
        if (best_on(config) < found)
            walk(config);
    }
    if (!task_.options.choose_predictors)
        return;
    for (const PredictorChoice predictors :
         {PredictorChoice::none, PredictorChoice::normal, PredictorChoice::normal_and_position}) {
        PayloadConfig config = trials_.best()->config;
        config.predictors = predictors;
        if (affordable(predictors))
            best_on(config);
    }
}

/// Tries all combinations, and the payloads from each: for few receivers this takes little time.
void BudgetSearch::vary_thoroughly() {
    const PayloadConfig from = trials_.best()->config;
    for (const PredictorChoice predictors :
         {PredictorChoice::none, PredictorChoice::normal, PredictorChoice::normal_and_position})
        for (const bool bases_count : {true, false}) {
            PayloadConfig config = from;
            config.bases_count = bases_count;
            if (task_.options.choose_predictors)
                config.predictors = predictors;
            if (affordable(config.predictors))
                walk(config);
        }
    if (!bases_are_coded(task_.options.compress))
        return;
    for (const double factor : tuning::kOtherShares) {
        PayloadConfig config = trials_.best()->config;
        config.basis_share = std::min(factor * basis_share(task_.options.compress), tuning::kMaxShare);
        walk(config);
    }
}

/// Completes the config of the best draft with all rounds and seams; if the result exceeds the budget, tries
/// other configs.
void BudgetSearch::finish() {
    if (!trials_.best()->trial.draft)
        return;
    PayloadConfig config = trials_.best()->config;
    config.finished = true;
    best_on(config);
    if (!trials_.kept())
        walk(config);
}

/// Searches with fewer components if even one cluster with all its directions takes too many bytes. Starts
/// from zero components and continues while the budget is met or the excess decreases. The mean of a single
/// cluster is the minimum.
void BudgetSearch::search_fewer_components() {
    const PredictorChoice predictors =
        task_.options.choose_predictors ? PredictorChoice::none : task_.options.compress.predictors;
    const int all = std::min(task_.packed() ? kMaxPackedComponents : 4 * min_payload(), task_.dimension());
    double best = kNothingFound;
    int worse = 0;
    for (int components = 0; components < std::max(all, 1) && worse < tuning::kPatience; ++components) {
        const bool kept = trials_.kept();
        const double found = walk({.payload = min_payload(),
                                   .component_limit = components,
                                   .predictors = predictors,
                                   .finished = true});
        worse = found < best || !kept ? 0 : worse + 1;
        best = std::min(best, found);
    }
}

double BudgetSearch::best_on(const PayloadConfig& config) {
    const auto [known, is_new] = min_cost_.try_emplace(config, kNothingFound);
    if (!is_new)
        return known->second;
    double least = kNothingFound;
    if (!task_.options.choose_clusters)
        least = trials_.cost(trials_.attempt(task_.options.compress.clusters, config));
    else if (trials_.saves_bytes())
        reach_error(config, least);
    else
        fill_bytes(config, least);
    return min_cost_[config] = least;
}

int BudgetSearch::clamped(double clusters) const {
    return static_cast<int>(std::clamp(std::round(clusters), 1.0, static_cast<double>(max_clusters_)));
}

/// Extrapolates the trial to the target error or size by typical exponents.
bool BudgetSearch::hopeless(const SearchTrial& t, const PayloadConfig& config) const {
    if (task_.few_receivers() || config.finished || !trials_.kept() ||
        (trials_.keeps(t) && trials_.cost(t) <= trials_.cost(trials_.best()->trial)))
        return false;
    const SearchTrial& best = trials_.best()->trial;
    const double payload = task_.payload_bytes(config.payload);
    // More clusters may gain more than the typical exponent predicts, and fewer may lose less.
    const auto exponent = [&](bool more) { return more ? steepest_ : tuning::kErrorExponentDown; };
    if (trials_.saves_bytes()) {
        const double excess = trials_.excess_of_error(t),
                     clusters = clusters_for(1 / excess, exponent(excess > 1));
        return payload + clusters * (t.bytes_per_vertex - payload) >
               tuning::kHopeless * best.bytes_per_vertex;
    }
    const double clusters = (max_bytes(config) - payload) / std::max(t.bytes_per_vertex - payload, 1e-9);
    return t.lit_rms * std::pow(clusters, -exponent(clusters > 1)) > tuning::kHopeless * best.lit_rms;
}

/// Estimates the size of bases per cluster before the first trial, from the rows of the best trial.
double BudgetSearch::bytes_per_cluster(const PayloadConfig& config) const {
    if (!trials_.best())
        return trials_.bytes_per_cluster();
    const SearchTrial& best = trials_.best()->trial;
    const PayloadConfig& on = trials_.best()->config;
    const double predictors = predictor_rows_of(on.predictors, task_.surface),
                 components = best.operations - predictors,
                 more = (1.0 + config.payload) / (1.0 + on.payload),
                 rows = 1 + predictor_rows_of(config.predictors, task_.surface) + more * components;
    return std::max((best.bytes_per_vertex - best.payload_bytes) * task_.receivers() / best.clusters * rows /
                        (1 + best.operations),
                    tuning::kMinBytesPerCluster);
}

/// Returns one cluster if components were reduced because nothing else fits.
double BudgetSearch::first_clusters_of_bytes(const PayloadConfig& config, double aim) const {
    if (config.component_limit < kMaxPackedComponents)
        return 1;
    if (config.finished)
        return trials_.best()->trial.clusters;
    return (aim - task_.payload_bytes(config.payload)) * task_.receivers() / bytes_per_cluster(config);
}

/// Halves the clusters while this lowers the cost. For transfer of few dimensions, more clusters take bits
/// from weights without benefit: fewer clusters leave bytes unused and have a smaller error.
void BudgetSearch::reduce_clusters(const PayloadConfig& config, int clusters, double& least) {
    int worse = 0;
    while (clusters > 1 && worse < tuning::kPatience) {
        clusters /= 2;
        const double cost = trials_.cost(trials_.attempt(clusters, config));
        worse = cost < least ? 0 : worse + 1;
        least = std::min(least, cost);
    }
}

/// Searches the maximum number of clusters that fit the bytes, between a number that fits and one that does
/// not; reduces it if the error grew with it.
void BudgetSearch::fill_bytes(const PayloadConfig& config, double& least) {
    const double most = max_bytes(config), aim = 0.5 * (1 + effort_.min_filled) * most;
    KnownClusters fits{0, task_.payload_bytes(config.payload)},
        too_many{static_cast<double>(max_clusters_) + 1, 0}, before;
    double next = first_clusters_of_bytes(config, aim);
    int best = 0, max_kept = 0;
    for (int i = 0; i < tuning::kBytesTries && fits.clusters + 1 < too_many.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, fits.clusters + 1, too_many.clusters - 1));
        const SearchTrial& trial = trials_.attempt(clusters, config);
        const double bytes = trial.bytes_per_vertex;
        if (const double cost = trials_.cost(trial); cost < least) {
            least = cost;
            best = clusters;
        }
        if (trials_.keeps(trial))
            max_kept = std::max(max_kept, clusters);
        if (before.clusters > 0)
            observed_exponent(before, {static_cast<double>(clusters), trial.lit_rms});
        before = {static_cast<double>(clusters), trial.lit_rms};
        (bytes <= most ? fits : too_many) = {static_cast<double>(clusters), bytes};
        if ((bytes <= most && bytes > effort_.min_filled * most) || hopeless(trial, config))
            break;
        if (too_many.value > 0)
            next = interpolated(fits, too_many, aim);
        else
            next = clusters + (aim - bytes) * task_.receivers() / trials_.bytes_per_cluster();
    }
    if (best > 0 && best < max_kept)
        reduce_clusters(config, best, least);
}

/// Estimates the first number of clusters for an error. Another word typically halves the error.
int BudgetSearch::first_clusters(const PayloadConfig& config) const {
    if (!trials_.best())
        return clamped(tuning::kFirstClusters);
    const SearchTrial& best = trials_.best()->trial;
    const int words = task_.packed() ? config.payload - trials_.best()->config.payload : 0;
    return clamped(best.clusters *
                   clusters_for(std::pow(2, words) / trials_.excess_of_error(best), tuning::kErrorExponent));
}

/// Returns whether another word reaches the error in fewer bytes, if the current payload would need many more
/// clusters.
bool BudgetSearch::wants_payload(const SearchTrial& t, const PayloadConfig& config, double exponent) const {
    if (!task_.packed() || config.payload == max_payload() || task_.few_receivers())
        return false;
    const double excess = trials_.excess_of_error(t), bases = t.bytes_per_vertex - t.payload_bytes;
    const double here = bases * clusters_for(1 / excess, exponent),
                 there = task_.payload_bytes(1) +
                         tuning::kBasesOfAWordMore * bases * clusters_for(2 / excess, tuning::kErrorExponent);
    return here > tuning::kClearlyMore * there;
}

/// Returns the slope of log error over log clusters: on small meshes it is far steeper than usual.
double BudgetSearch::observed_exponent(const KnownClusters& a, const KnownClusters& b) {
    const double ratio = std::log(b.clusters / a.clusters),
                 exponent = std::clamp(-std::log(b.value / a.value) / ratio, tuning::kMinErrorExponent,
                                       tuning::kMaxErrorExponent);
    if (std::abs(ratio) > tuning::kTellingRatio)
        steepest_ = std::max(steepest_, exponent);
    return exponent;
}

/// Searches the minimum number of clusters that reaches the error, between a number that misses and one that
/// reaches it. Log error is assumed linear in log clusters, with a slope from the last two trials or a
/// typical value.
void BudgetSearch::reach_error(const PayloadConfig& config, double& least) {
    const double near_enough =
        config.finished || !task_.has_drafts() ? tuning::kNearEnough : tuning::kNearEnoughOfDrafts;
    const double aim = 0.3 * near_enough + 0.7;
    KnownClusters misses{0, 0}, reaches{static_cast<double>(max_clusters_) + 1, 0}, before;
    double next = first_clusters(config), exponent = tuning::kErrorExponent;
    for (int i = 0; i < tuning::kErrorTries && misses.clusters + 1 < reaches.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, misses.clusters + 1, reaches.clusters - 1));
        const SearchTrial& trial = trials_.attempt(clusters, config);
        least = std::min(least, trials_.cost(trial));
        const double excess = std::max(trials_.excess_of_error(trial), 1e-12);
        const bool enough = excess <= 1;
        (enough ? reaches : misses) = {static_cast<double>(clusters), excess};
        if ((enough && excess > near_enough) || hopeless(trial, config))
            break;
        if (misses.value > 0 && reaches.value > 0 &&
            reaches.clusters < misses.clusters * tuning::kNearClusters)
            break;
        // If the bytes already exceed the budget, more clusters only increase the cost.
        if (!enough && trial.bytes_per_vertex > budget_.bytes_per_vertex.value_or(kNothingFound))
            break;
        if (before.clusters > 0)
            exponent = observed_exponent(before, {static_cast<double>(clusters), excess});
        before = {static_cast<double>(clusters), excess};
        if (!enough && !trials_.kept() && !config.finished && wants_payload(trial, config, exponent))
            break;
        const double factor = clusters_for(std::clamp(aim / excess, std::exp(-2.0), std::exp(2.0)), exponent);
        if (!(reaches.value > 0) && factor > tuning::kHopelessFactor) // a larger payload is needed
            break;
        next = clusters * std::clamp(factor, 1 / tuning::kHopelessFactor, tuning::kMaxGrowth);
        if (misses.value > 0 && reaches.value > 0 && !(next > misses.clusters && next < reaches.clusters))
            next = std::sqrt(misses.clusters * reaches.clusters);
    }
}

} // namespace prt
