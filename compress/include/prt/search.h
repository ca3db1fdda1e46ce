#pragma once

// Options for a budget: how many clusters and bits reach an error, or what error a number of bytes reaches.

#include "prt/compress.h"
#include "prt/transfer_layout.h"

#include <optional>
#include <vector>

namespace prt {

/// What the result must keep. At least one is given.
struct Budget {
    std::optional<double> max_error =
        {}; ///< lit_rms, expected under the metric, and under `skies`; contrast errors
    std::optional<double> bytes_per_vertex = {}; ///< what a game binds (`bytes_per_receiver`), and bases
    std::optional<double> operations = {};       ///< of all receivers, guides with them: what the shader pays
    /// Jumps of contrast between clusters (`ClusterJumps::percentile_99`) under the metric, or under
    /// `skies_of_jumps` where given. Needs another limit beside it, since one cluster has no jumps.
    std::optional<double> max_jump = {};
    /// Under each of these, at every turn about +Y, `max_error` holds, too.
    std::vector<Lighting> skies = {};
    /// Under each of these, turned about +Y, `max_jump` holds.
    std::vector<Lighting> skies_of_jumps = {};

    bool any() const { return max_error || max_jump || bytes_per_vertex || operations; }
    bool aims() const { return max_error || bytes_per_vertex || operations; }
};

/// A figure that a budget limits.
enum class Promise { error, skies, lamps, jump, bytes, operations };

/// A figure of a result and its limit.
struct PromiseKept {
    Promise promise;
    double reached = 0, limit = 1;
    double share() const { return reached / limit; }
};

/// The figures of `trial` that `budget` limits, nearest to its limit first: the first one decided the size or
/// the error of what a search found.
std::vector<PromiseKept> promises_of(const Budget& budget, const SearchTrial& trial);

struct SearchOptions {
    CompressOptions compress;      ///< what the search does not choose: metric, seams, seed, threads, format
    bool choose_clusters = true;   ///< else compress.clusters holds
    bool choose_components = true; ///< else compress.coding.components holds as the most, packed or not
    bool choose_guides = true;     ///< else compress.guides holds
    /// 32-bit words of a receiver, or groups of four weights that are not packed; 0: the search chooses.
    int payload = 0;
    Budget budget;
};

struct SearchResult {
    /// The cheapest that keeps all of the budget, else the nearest to it; its seconds are those of all tries.
    CompressResult result;
    bool kept = false;
    SearchTrial best; ///< what led to it, with what it promises; of a preset that fits nothing
    std::vector<SearchTrial> trials;
};

/// Compresses with the guides and numbers of clusters, components and bits that are cheapest in bytes under
/// `max_error`, or best in error under `bytes_per_vertex`, or, under `operations` alone, in as
/// many bytes as a preset may take, and at most 512 clusters. Takes three to six times as long as `compress`:
/// later tries start from the clusters of earlier ones. Throws as `compress` does, for budgets that are not
/// positive, and for guides that take more operations than there may be.
SearchResult compress_within(const TransferView& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress = {});

/// A coding (`preset_u32` and its like, or weights that are not packed) that fits small meshes, too: as it
/// is where its bases take at most twice the bytes of the weights, or 4 KB; else the clusters and bits that
/// lose least in as many words and no more bytes of bases than that. `kept` is false where nothing is as
/// small.
SearchResult compress_preset(const TransferView& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress = {});

} // namespace prt
