// Runs and compares the trials of a search.
#include "compress/search/trials.h"

#include "compress/pipeline/compress_from.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace prt {
namespace {

constexpr double kNotKept = 1e6; ///< minimum cost of a result outside the budget, above any error or size

} // namespace

std::optional<double> SearchTask::components_beside(PredictorChoice predictors) const {
    if (!options.budget.operations)
        return std::nullopt;
    return *options.budget.operations - predictor_rows_of(predictors, surface);
}

Trials::Trials(const SearchTask& task)
    : task_(task), budget_(task.options.budget),
      light_(task.transfer, task.surface.areas, *task.options.compress.metric, task.options.compress.threads),
      evaluate_(task.transfer, task.surface, *task.options.compress.metric, budget_,
                task.options.compress.threads),
      bytes_per_cluster_(tuning::kBytesPerClusterAndNumber * task.dimension()) {}

double Trials::excess_of_error(const SearchTrial& t) const {
    double excess = 0;
    for (const PromiseKept& kept : promises_of(budget_, t))
        if (kept.promise != Promise::bytes && kept.promise != Promise::operations)
            excess = std::max(excess, kept.share());
    return excess;
}

double Trials::excess(const SearchTrial& t) const {
    return promises_of(budget_, t).front().share();
}

double Trials::cost(const SearchTrial& t) const {
    if (!keeps(t))
        return kNotKept * excess(t);
    return saves_bytes() ? t.bytes_per_vertex : t.lit_rms;
}

CompressOptions Trials::options_on(const PayloadConfig& config, int clusters) const {
    CompressOptions o = task_.options.compress;
    WeightCoding& coding = o.coding;
    o.clusters = clusters;
    o.predictors = config.predictors;
    if (config.basis_share >= 0)
        o.basis_share = config.basis_share;
    int most = 4 * config.payload;
    if (task_.packed()) {
        coding.cluster_bits = static_cast<int>(std::bit_width(static_cast<unsigned>(clusters - 1)));
        o.bases_count = config.bases_count;
        coding.fixed_bits.clear();
        coding.bits =
            std::min(32 * config.payload - coding.cluster_bits, kMaxPackedBits); // words are bound as a whole
        most = kMaxPackedComponents;
    }
    if (task_.options.choose_components)
        coding.components = std::min({most, task_.dimension(), config.component_limit});
    if (const std::optional<double> components = task_.components_beside(config.predictors)) {
        o.mean_components = std::max(*components, 0.0);
        if (!(*components > 0)) // `compress` treats 0 as no limit
            coding.components = 0;
    }
    return o;
}

/// Returns the clusters of the last or the best trial, the one closer in number. Few clusters are found
/// quickly from scratch; clusters of a very different number are a bad start.
std::span<const std::uint16_t> Trials::start_for(int clusters) const {
    if (clusters <= tuning::kAlwaysFresh || !task_.has_drafts())
        return {};
    double nearest = std::log(tuning::kFarStart);
    std::span<const std::uint16_t> start;
    const auto consider = [&](const std::optional<KeptTrial>& from,
                              const std::vector<std::uint16_t>& of_receivers) {
        if (!from)
            return;
        const double distance = std::abs(std::log(static_cast<double>(from->trial.clusters) / clusters));
        if (distance <= nearest) {
            nearest = distance;
            start = of_receivers;
        }
    };
    consider(best_, best_clusters_);
    consider(last_, last_clusters_);
    return start;
}

const SearchTrial& Trials::attempt(int clusters, const PayloadConfig& config) {
    const auto key = std::pair(clusters, config);
    if (const auto known = tried_.find(key); known != tried_.end())
        return known->second;
    // The number of trials is unknown; each takes a tenth of the remaining progress.
    const double done = 1 - std::pow(0.9, static_cast<double>(tried_.size()));
    const bool draft = !config.finished && task_.has_drafts();
    CompressResult result =
        compress_from({start_for(clusters), draft, &light_}, task_.transfer, task_.surface,
                      options_on(config, clusters), task_.progress.range(done, done + 0.1 * (1 - done)));
    const CompressStatistics& s = result.statistics;
    const Score score = evaluate_(result);
    const double finished = draft ? tuning::kFinishedOverDraft : 1;
    const SearchTrial trial{.draft = draft,
                            .clusters = clusters,
                            .payload_bytes = static_cast<int>(s.bytes_per_receiver),
                            .lit_rms = finished * s.error(),
                            .worst_lit_rms = finished * score.worst_lit_rms,
                            .sky_contrast = finished * s.sky_contrast,
                            .lamp_contrast = finished * s.lamp_contrast,
                            .jump = finished * score.jump,
                            .bytes_per_vertex = s.bytes_with_bases(task_.transfer.receivers()),
                            .operations = s.operations(),
                            .seconds = s.seconds};
    bytes_per_cluster_ = std::max(tuning::kMinBytesPerCluster,
                                  static_cast<double>(s.basis_bytes) / static_cast<double>(s.clusters));
    if (task_.options.compress.trace)
        task_.options.compress.trace(trial);
    result_.trials.push_back(trial);
    keep_if_better(std::move(result), trial, config);
    return tried_[key] = trial;
}

bool Trials::is_better(const SearchTrial& trial) const {
    if (!best_ || trial.draft != best_->trial.draft)
        return !best_ || best_->trial.draft;
    return cost(trial) < cost(best_->trial);
}

void Trials::keep_if_better(CompressResult&& result, const SearchTrial& trial, const PayloadConfig& config) {
    std::vector<std::uint16_t> clusters = result.transfer.receivers.cluster_indices();
    if (!is_better(trial)) {
        last_ = {trial, config};
        last_clusters_ = std::move(clusters);
        return;
    }
    if (best_) {
        last_ = best_;
        last_clusters_ = std::move(best_clusters_);
    }
    best_ = {trial, config};
    best_clusters_ = std::move(clusters);
    result_.result = std::move(result);
}

SearchResult Trials::take_result() {
    result_.kept = kept();
    result_.best = best_->trial;
    return std::move(result_);
}

} // namespace prt
