#pragma once

// Search of compression settings within a budget.

#include "compress/search/trials.h"
#include "compress/tuning/tuning.h"

namespace prt {

/// Effort of a search (tuning.h).
struct Effort {
    double min_filled = tuning::kMinFilled;
    double both_ways = tuning::kBothWays;
    std::optional<double> bytes_per_cluster = {}; ///< size of the bases, if known before the first trial
};

/// Returns the effort for a preset that does not fit.
Effort effort_of_preset(const CompressStatistics& too_large);

/// A number of clusters and the value measured for it.
struct KnownClusters {
    double clusters = 0, value = 0;
};

/// Searches the best result within a budget: varies the clusters on configs of otherwise fixed settings, then
/// the payload, then all other settings from the best one. A config is abandoned as soon as its trials
/// predict that it cannot win.
class BudgetSearch {
public:
    explicit BudgetSearch(const SearchTask& task, const Effort& effort = {});
    SearchResult run();

private:
    PayloadConfig first_config() const;
    int first_payload() const;
    int min_payload() const;
    int max_payload() const;
    int max_clusters() const;
    /// Returns the bytes per receiver that a config may fill: the budget's, or, without a limit on bytes, the
    /// maximum size of a preset.
    double max_bytes(const PayloadConfig& config) const;
    bool affordable(PredictorChoice predictors) const;

    /// Searches configs of all payloads around `config`'s. Returns the minimum cost.
    double walk(const PayloadConfig& config);
    /// Varies the other settings, starting from the best result.
    void vary();
    void vary_thoroughly();
    void finish();
    void search_fewer_components();

    /// Searches the best number of clusters on a config, by bytes or by error. Returns its cost.
    double best_on(const PayloadConfig& config);
    double bytes_per_cluster(const PayloadConfig& config) const;
    double first_clusters_of_bytes(const PayloadConfig& config, double aim) const;
    void fill_bytes(const PayloadConfig& config, double& least);
    void reduce_clusters(const PayloadConfig& config, int clusters, double& least);
    void reach_error(const PayloadConfig& config, double& least);
    int first_clusters(const PayloadConfig& config) const;
    double observed_exponent(const KnownClusters& a, const KnownClusters& b);
    bool wants_payload(const SearchTrial& trial, const PayloadConfig& config, double exponent) const;
    /// Returns whether a trial predicts that its config is worse than the best result.
    bool hopeless(const SearchTrial& trial, const PayloadConfig& config) const;
    int clamped(double clusters) const;

    const SearchTask& task_;
    const Budget& budget_;
    Effort effort_;
    Trials trials_;
    int max_clusters_;
    double steepest_ = tuning::kErrorExponent; ///< maximum over all observations
    std::map<PayloadConfig, double> min_cost_;
};

} // namespace prt
