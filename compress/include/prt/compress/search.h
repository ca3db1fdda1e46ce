#pragma once

// Searches options for a budget: the smallest size for a given error, or the minimum error for a given size.

#include "prt/compress/compress.h"
#include "prt/core/transfer_layout.h"

#include <optional>
#include <vector>

namespace prt {

/// Limits for the result; a limit without a value does not apply. `max_error`, `bytes_per_vertex` or
/// `operations` is required. All limits must be positive and finite.
struct Budget {
    /// Limit for `CompressStatistics::error`, and for `lit_rms` under each of `skies` at every rotation about
    /// +Y. A fraction: 0.03 = 3 %.
    std::optional<double> max_error = {};
    /// Limit for the bytes per receiver that a game binds (`CompressStatistics::bytes_per_receiver`), plus
    /// the bytes of all bases divided by the number of receivers.
    std::optional<double> bytes_per_vertex = {};
    /// Limit for `CompressStatistics::operations`: mean number of multiply-adds per receiver in the shader.
    std::optional<double> operations = {};
    /// Limit for the jumps of the contrast error between clusters (`ClusterJumps::percentile_99`), under the
    /// metric, or under `skies_of_jumps` if these are set. A fraction: 0.05 = 5 %. Requires another limit,
    /// because a single cluster has no jumps.
    std::optional<double> max_jump = {};
    /// Skies for `max_error`, in addition to the metric; may be empty. Require `max_error`.
    std::vector<Lighting> skies = {};
    /// Skies for `max_jump`, each at kRotationsOfJumps rotations about +Y. Empty: jumps are measured under
    /// the metric. Require `max_jump`.
    std::vector<Lighting> skies_of_jumps = {};

    /// Returns whether there is any limit.
    bool any() const { return max_error || max_jump || bytes_per_vertex || operations; }
    /// Returns whether there is a limit other than `max_jump`.
    bool aims() const { return max_error || bytes_per_vertex || operations; }
};

/// A quantity of a `SearchTrial` that a budget limits: `error` is worst_lit_rms, `skies` is sky_contrast,
/// `lamps` is lamp_contrast (all three: limit max_error), `jump` is jump (max_jump), `bytes` is
/// bytes_per_vertex, `operations` is operations.
enum class Promise { error, skies, lamps, jump, bytes, operations };

/// A quantity of a trial, with the limit of the budget.
struct PromiseKept {
    Promise promise;
    /// Value of the quantity in the trial, and its limit in the budget, in the same unit.
    double reached = 0, limit = 1;
    /// Returns the value as a fraction of the limit; above 1 the trial exceeds the limit.
    double share() const { return reached / limit; }
};

/// Returns the quantities of `trial` that `budget` limits, sorted by `PromiseKept::share`, largest first. The
/// first quantity is the limit that determined the size or the error of the result. Omits contrast errors
/// that are 0.
std::vector<PromiseKept> promises_of(const Budget& budget, const SearchTrial& trial);

/// Settings of a search.
struct SearchOptions {
    /// Settings of each trial; all must be valid for `compress`. The search keeps the metric, `seam_weight`,
    /// `seed`, `threads`, `trace` and the format of weights. It also keeps `mean_components` unless the
    /// budget limits operations, and `basis_share`, for which it tries other values if there are few
    /// receivers. It replaces `bases_count` and the sizes (`clusters`, `predictors`, components, bits),
    /// except as the following members specify.
    CompressOptions compress;
    bool choose_clusters = true; ///< true: the search chooses the number; false: it uses compress.clusters
    /// True: the search chooses the maximum number of components of a cluster. False: it uses
    /// compress.coding.components, for packed and float weights.
    bool choose_components = true;
    bool choose_predictors = true; ///< true: the search chooses; false: it uses compress.predictors
    /// Size of the weights of a receiver. Packed: number of 32-bit words, including the cluster index, at
    /// most kMaxPackedWords. Float: number of groups of four weights. 0: the search chooses.
    int payload = 0;
    Budget budget; ///< limits for the result
};

/// Result of a search.
struct SearchResult {
    /// The best result within the budget; if no trial meets the budget, the result that exceeds it least.
    /// `statistics.seconds` is the duration of the whole search.
    CompressResult result;
    bool kept = false; ///< true: `result` is within the budget
    SearchTrial
        best; ///< the trial that produced `result`; default values if `compress_preset` did not search
    std::vector<SearchTrial> trials; ///< all trials in the order of execution; empty without a search
};

/// Compresses within `options.budget`. With `max_error` it minimises the bytes, else the error. It chooses
/// predictors and the numbers of clusters, components and bits. If the budget limits neither error nor bytes,
/// it chooses at most 512 clusters, and aims at bases of at most twice the bytes of the weights. Takes three
/// to six times as long as `compress`. If no trial meets the budget, this is not an error:
/// `SearchResult::kept` is false. Throws the errors of `compress`. Throws `Error` if the budget has no limit
/// except `max_jump`, if a limit is not positive and finite, if skies are set without their limit, or if
/// fixed predictors exceed `operations`. For skies of the budget throws the errors of
/// `lit_rms_over_rotations` (compress/metric/error_moments.h) and of `ClusterJumps`
/// (compress/metric/jumps.h).
SearchResult compress_within(const TransferView& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress = {});

/// Compresses with `options.coding`, such as `preset_u32` or float weights, and adapts small meshes, whose
/// bases would be larger than their weights. First compresses with `options`; if the bases take at most twice
/// the bytes of the weights, or at most 4 KB, this is the result. Otherwise searches for the minimum error
/// with bases within that limit and with the same number of words (or groups of float weights) per receiver:
/// chooses clusters and, for packed weights, components and bits. `SearchResult::kept` is false if the bases
/// of the result still exceed the limit. Ignores `options.bases_count`. Throws the errors of `compress`.
SearchResult compress_preset(const TransferView& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress = {});

} // namespace prt
