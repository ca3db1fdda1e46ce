#pragma once

#include "metric/seen_light.h"
#include "prt/search.h"
#include "search/judge.h"
#include "search/line.h"
#include "tuning.h"

#include <map>

namespace prt {

/// What is compressed, and what for. Keeps references.
struct SearchTask {
    const TransferView& transfer;
    const ReceiverSurface& surface;
    SearchOptions options; ///< with a metric
    const Progress& progress;

    double receivers() const { return static_cast<double>(transfer.receivers()); }
    /// So few are searched all ways.
    bool few_receivers() const { return receivers() <= tuning::kFewReceivers; }
    /// Else all tries are finished: that takes no time to speak of.
    bool has_drafts() const { return receivers() > tuning::kAlwaysFinished; }
    int dimension() const { return static_cast<int>(transfer.dimension()); }
    bool packed() const { return options.compress.coding.format == WeightFormat::packed; }
    double payload_bytes(int payload) const {
        return prt::payload_bytes(options.compress.coding.format, payload);
    }
    /// Components that operations have room for beside guides; nothing where they are not asked about.
    std::optional<double> components_beside(GuideChoice guides) const;
};

/// Tries of a search, each made once, from the clusters of one before it where these are not too different.
/// Keeps the best; a finished one is better than any draft.
class Trials {
public:
    struct Try {
        SearchTrial trial;
        Line line;
    };

    explicit Trials(const SearchTask& task);

    const SearchTrial& attempt(int clusters, const Line& line);

    bool keeps(const SearchTrial& trial) const { return !(excess(trial) > 1); }
    /// The greatest of all figures over what the budget allows: above 1 it is not kept.
    double excess(const SearchTrial& trial) const;
    /// The same of errors and jumps alone.
    double excess_of_error(const SearchTrial& trial) const;
    /// What is made small once the budget is kept; while it is not, how far off it is.
    double cost(const SearchTrial& trial) const;
    /// Whether bytes are made small, at an error that is allowed, rather than the error.
    bool saves_bytes() const { return budget_.max_error.has_value(); }

    const std::optional<Try>& best() const { return best_; }
    bool kept() const { return best_ && keeps(best_->trial); }
    /// Bytes of the bases of a cluster in the last try.
    double bytes_per_cluster() const { return bytes_per_cluster_; }
    void expect_bytes_per_cluster(double bytes) { bytes_per_cluster_ = bytes; }
    /// The best, and all tries. Ends the search.
    SearchResult take_result();

private:
    CompressOptions options_on(const Line& line, int clusters) const;
    std::span<const std::uint16_t> start_for(int clusters) const;
    bool is_better(const SearchTrial& trial) const;
    void keep_if_better(CompressResult&& result, const SearchTrial& trial, const Line& line);

    const SearchTask& task_;
    const Budget& budget_;
    SeenLight light_;
    Judge judge_;
    double bytes_per_cluster_;
    std::map<std::pair<int, Line>, SearchTrial> tried_;
    std::optional<Try> last_; ///< unless it is the best
    std::vector<std::uint16_t> last_clusters_;
    std::optional<Try> best_;
    SearchResult result_;
};

} // namespace prt
