#pragma once

#include "search/trials.h"
#include "tuning.h"

namespace prt {

/// How hard a search tries (tuning.h).
struct Effort {
    double least_filled = tuning::kLeastFilled;
    double both_ways = tuning::kBothWays;
    std::optional<double> bytes_per_cluster = {}; ///< of the bases, where they are known before the first try
};

/// Of a preset that does not fit.
Effort effort_of_preset(const CompressStatistics& too_large);

/// A number of clusters and what it led to.
struct KnownClusters {
    double clusters = 0, value = 0;
};

/// Looks for the best that keeps a budget: on lines of so many clusters, along payloads, and then the other
/// ways from the best of them. A line is left as soon as its tries so far say that it will not win.
class BudgetSearch {
public:
    explicit BudgetSearch(const SearchTask& task, const Effort& effort = {});
    SearchResult run();

private:
    Line first_line() const;
    int first_payload() const;
    int least_payload() const;
    int most_payload() const;
    int most_clusters() const;
    /// Bytes per receiver that a line may fill: the budget's, or, where bytes are not asked about, as much as
    /// a preset may.
    double most_bytes(const Line& line) const;
    bool affordable(GuideChoice guides) const;

    /// Lines of all payloads about `line`'s. Returns the least cost.
    double walk(const Line& line);
    /// The other ways to spend, from the best found.
    void vary();
    void vary_thoroughly();
    void finish();
    void search_fewer_components();

    /// The best number of clusters on a line: by bytes or by error. Returns its cost.
    double best_on(const Line& line);
    double bytes_per_cluster(const Line& line) const;
    double first_clusters_of_bytes(const Line& line, double aim) const;
    void fill_bytes(const Line& line, double& least);
    void reduce_clusters(const Line& line, int clusters, double& least);
    void reach_error(const Line& line, double& least);
    int first_clusters(const Line& line) const;
    double observed_exponent(const KnownClusters& a, const KnownClusters& b);
    bool wants_payload(const SearchTrial& trial, const Line& line, double exponent) const;
    /// Whether what a try says of its line is worse than what there is.
    bool hopeless(const SearchTrial& trial, const Line& line) const;
    int clamped(double clusters) const;

    const SearchTask& task_;
    const Budget& budget_;
    Effort effort_;
    Trials trials_;
    int most_clusters_;
    double steepest_ = tuning::kErrorExponent; ///< of all that were observed
    std::map<Line, double> least_cost_;
};

} // namespace prt
