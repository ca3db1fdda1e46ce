#pragma once

// Searches options for a budget: the smallest size for a given error, or the minimum error for a given size.

#include "prt/compress.h"
#include "prt/transfer_layout.h"

#include <optional>
#include <vector>

namespace prt {

/// Limits for the result. At least one is required.
struct Budget {
    /// Limit for `CompressStatistics::error`, and for `lit_rms` under each of `skies` at every rotation about
    /// +Y.
    std::optional<double> max_error = {};
    /// Limit for the size that a game binds (`bytes_per_receiver`), plus bases.
    std::optional<double> bytes_per_vertex = {};
    /// Limit for `CompressStatistics::operations`, the cost in the shader.
    std::optional<double> operations = {};
    /// Limit for contrast jumps between clusters (`ClusterJumps::percentile_99`) under the metric, or under
    /// `skies_of_jumps` if these are set. Requires another limit, because a single cluster has no jumps.
    std::optional<double> max_jump = {};
    /// Skies for `max_error`, in addition to the metric.
    std::vector<Lighting> skies = {};
    /// Skies for `max_jump`, at rotations about +Y; empty: the metric.
    std::vector<Lighting> skies_of_jumps = {};

    /// Returns whether there is any limit.
    bool any() const { return max_error || max_jump || bytes_per_vertex || operations; }
    /// Returns whether there is a limit other than `max_jump`.
    bool aims() const { return max_error || bytes_per_vertex || operations; }
};

/// A quantity that a budget limits.
enum class Promise { error, skies, lamps, jump, bytes, operations };

/// A limited quantity of a result, with its limit.
struct PromiseKept {
    Promise promise;
    double reached = 0, limit = 1;
    double share() const { return reached / limit; }
};

/// Returns the quantities of `trial` that `budget` limits, the one nearest to its limit first. The first one
/// determined the size or the error of the result.
std::vector<PromiseKept> promises_of(const Budget& budget, const SearchTrial& trial);

/// Settings of a search.
struct SearchOptions {
    CompressOptions compress;    ///< settings that the search does not change: metric, seams, seed, threads,
                                 ///< format of weights
    bool choose_clusters = true; ///< false: uses compress.clusters
    /// False: compress.coding.components is the maximum, for packed and unpacked weights.
    bool choose_components = true;
    bool choose_predictors = true; ///< false: uses compress.predictors
    /// Number of 32-bit words per receiver, or of groups of four unpacked weights; 0: the search chooses.
    int payload = 0;
    Budget budget;
};

/// Result of a search.
struct SearchResult {
    /// The best result within the budget; if nothing meets the budget, the closest result. `seconds` includes
    /// all trials.
    CompressResult result;
    bool kept = false; ///< whether the result is within the budget
    SearchTrial best;  ///< the trial behind `result`; default values if a preset was used unchanged
    std::vector<SearchTrial> trials;
};

/// Compresses with the predictors and the numbers of clusters, components and bits that need the fewest bytes
/// for `max_error`, or have the minimum error for `bytes_per_vertex`. With `operations` alone, the size is
/// limited to that of a preset and to 512 clusters. Takes three to six times as long as `compress`: later
/// trials start from the clusters of earlier ones. Throws the errors of `compress`, and `Error` for budgets
/// that are not positive and for predictors that exceed the operations.
SearchResult compress_within(const TransferView& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress = {});

/// Compresses with a fixed coding, such as `preset_u32` or unpacked weights, and adapts it to small meshes.
/// The coding is used unchanged if its bases take at most twice the bytes of the weights, or 4 KB. Otherwise
/// the search chooses clusters and bits with the minimum error for the same number of words and for bases
/// within that limit. `kept` is false if no result is within it.
SearchResult compress_preset(const TransferView& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress = {});

} // namespace prt
