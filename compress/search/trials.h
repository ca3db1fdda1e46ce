#pragma once

// Trials of a search.

#include "compress/metric/seen_light.h"
#include "compress/search/payload_config.h"
#include "compress/search/trial_evaluator.h"
#include "compress/tuning/tuning.h"
#include "prt/compress/search.h"

#include <map>

namespace prt {

/// Input and options of a search. Keeps references.
struct SearchTask {
    const TransferView& transfer;
    const ReceiverSurface& surface;
    SearchOptions options; ///< including a metric
    const Progress& progress;

    double receivers() const { return static_cast<double>(transfer.receivers()); }
    /// Returns whether the mesh is small enough to search all combinations.
    bool few_receivers() const { return receivers() <= tuning::kFewReceivers; }
    /// Returns whether trials start as drafts; for very small meshes all trials are complete, which takes
    /// little time.
    bool has_drafts() const { return receivers() > tuning::kAlwaysFinished; }
    int dimension() const { return static_cast<int>(transfer.dimension()); }
    bool packed() const { return options.compress.coding.format == WeightFormat::packed; }
    double payload_bytes(int payload) const {
        return prt::payload_bytes(options.compress.coding.format, payload);
    }
    /// Returns the components that operations allow in addition to predictors; no value without a limit.
    std::optional<double> components_beside(PredictorChoice predictors) const;
};

/// Trials of a search, each run once, starting from the clusters of a similar earlier trial. Keeps the best;
/// a complete trial is better than any draft.
class Trials {
public:
    struct KeptTrial {
        SearchTrial trial;
        PayloadConfig config;
    };

    explicit Trials(const SearchTask& task);

    const SearchTrial& attempt(int clusters, const PayloadConfig& config);

    bool keeps(const SearchTrial& trial) const { return !(excess(trial) > 1); }
    /// Returns the maximum ratio of a quantity to its limit; above 1 the budget is exceeded.
    double excess(const SearchTrial& trial) const;
    /// Returns the maximum ratio to the limit for errors and jumps only.
    double excess_of_error(const SearchTrial& trial) const;
    /// Returns the quantity to minimise if the budget is met; otherwise a cost that measures the excess.
    double cost(const SearchTrial& trial) const;
    /// Returns whether the search minimises bytes at an allowed error, rather than the error.
    bool saves_bytes() const { return budget_.max_error.has_value(); }

    const std::optional<KeptTrial>& best() const { return best_; }
    bool kept() const { return best_ && keeps(best_->trial); }
    /// Returns the bytes of the bases per cluster in the last trial.
    double bytes_per_cluster() const { return bytes_per_cluster_; }
    void expect_bytes_per_cluster(double bytes) { bytes_per_cluster_ = bytes; }
    /// Returns the best result, and all trials. Ends the search.
    SearchResult take_result();

private:
    CompressOptions options_on(const PayloadConfig& config, int clusters) const;
    std::span<const std::uint16_t> start_for(int clusters) const;
    bool is_better(const SearchTrial& trial) const;
    void keep_if_better(CompressResult&& result, const SearchTrial& trial, const PayloadConfig& config);

    const SearchTask& task_;
    const Budget& budget_;
    SeenLight light_;
    TrialEvaluator evaluate_;
    double bytes_per_cluster_;
    std::map<std::pair<int, PayloadConfig>, SearchTrial> tried_;
    std::optional<KeptTrial> last_; ///< empty if it is the best
    std::vector<std::uint16_t> last_clusters_, best_clusters_;
    std::optional<KeptTrial> best_;
    SearchResult result_;
};

} // namespace prt
