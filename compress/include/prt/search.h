#pragma once

// Search of options for a budget: the clusters and bits for a given error, or the minimum error for a given
// size.

#include "prt/compress.h"
#include "prt/transfer_layout.h"

#include <optional>
#include <vector>

namespace prt {

/// Limits for the result. At least one is required.
struct Budget {
    std::optional<double> max_error =
        {}; ///< lit_rms, expected under the metric, and under `skies`; contrast errors
    std::optional<double> bytes_per_vertex = {}; ///< size bound by a game (`bytes_per_receiver`), plus bases
    std::optional<double> operations = {};       ///< mean over receivers, including predictors: the cost in
                                                 ///< the shader
    /// Contrast jumps between clusters (`ClusterJumps::percentile_99`) under the metric, or under
    /// `skies_of_jumps` if given. Requires another limit as well, since one cluster has no jumps.
    std::optional<double> max_jump = {};
    /// `max_error` must also hold under each of these at every rotation about +Y.
    std::vector<Lighting> skies = {};
    /// `max_jump` must hold under each of these, rotated about +Y.
    std::vector<Lighting> skies_of_jumps = {};

    bool any() const { return max_error || max_jump || bytes_per_vertex || operations; }
    bool aims() const { return max_error || bytes_per_vertex || operations; }
};

/// A quantity that a budget limits.
enum class Promise { error, skies, lamps, jump, bytes, operations };

/// A quantity of a result with its limit.
struct PromiseKept {
    Promise promise;
    double reached = 0, limit = 1;
    double share() const { return reached / limit; }
};

/// Returns the quantities of `trial` that `budget` limits, nearest to its limit first. The first one
/// determined the size or the error of the result.
std::vector<PromiseKept> promises_of(const Budget& budget, const SearchTrial& trial);

struct SearchOptions {
    CompressOptions compress;      ///< settings that the search does not choose: metric, seams, seed,
                                   ///< threads, format
    bool choose_clusters = true;   ///< false: uses compress.clusters
    bool choose_components = true; ///< false: compress.coding.components is the maximum, packed or not
    bool choose_predictors = true; ///< false: uses compress.predictors
    /// 32-bit words per receiver, or groups of four unpacked weights; 0: the search chooses.
    int payload = 0;
    Budget budget;
};

struct SearchResult {
    /// The cheapest result within the budget, or the closest one; its seconds include all trials.
    CompressResult result;
    bool kept = false;
    SearchTrial best; ///< the trial behind `result`; default values if a preset was used unchanged
    std::vector<SearchTrial> trials;
};

/// Compresses with the predictors and numbers of clusters, components and bits that need the fewest bytes
/// under `max_error`, or have the minimum error under `bytes_per_vertex`. With `operations` alone, the size
/// is limited to that of a preset and to 512 clusters. Takes three to six times as long as `compress`: later
/// trials start from the clusters of earlier ones. Throws as `compress`, for budgets that are not positive,
/// and for predictors that exceed the operations.
SearchResult compress_within(const TransferView& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress = {});

/// Compresses with a fixed coding (such as `preset_u32`, or unpacked weights), adapted to small meshes. The
/// coding is used unchanged if its bases take at most twice the bytes of the weights, or 4 KB. Otherwise the
/// search chooses the clusters and bits with the minimum error in the same number of words and within that
/// size of the bases. `kept` is false if nothing is that small.
SearchResult compress_preset(const TransferView& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress = {});

} // namespace prt
