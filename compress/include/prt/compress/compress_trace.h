#pragma once

// Events that the compressor reports about its progress: `CompressOptions::trace`. Experimental: events may
// change between versions. Events name a cluster by its index at that time, counted from 0; the compressor
// later changes these indices.

#include <cstddef>
#include <functional>
#include <variant>

namespace prt {

/// The initial clusters exist: from vector quantisation, or in a search from the clusters of an earlier
/// trial. `clusters`: number of clusters. `axes`: number of principal axes of the transfer vectors that the
/// compressor keeps; it drops axes with almost no variance. If it dropped too much, it starts again with more
/// axes, and this event occurs again.
struct ClustersSeeded {
    std::size_t clusters, axes;
};

/// One round of clustered PCA has ended. Weights are not quantised yet. Rounds that add components, that test
/// moves, or that limit the mean number of components cause no event.
struct ClusteringRound {
    int component_limit; ///< maximum number of components of a cluster in this round
    /// Squared error, weighted as in docs/math.md, eq. 28c (with lamps: approximately eq. 28b), plus the
    /// expected loss by quantisation of weights, plus the costs of components and rows (Lagrange
    /// multipliers).
    double cost;
};

/// The compressor splits `cluster`: its receivers on one side of its mean, along its first direction, move to
/// cluster `into`, which had no receivers or did not exist before. `MovesTried` reports whether the split
/// remains.
struct ClusterSplit {
    std::size_t cluster, into;
    double gain; ///< expected decrease of `ClusteringRound::cost`
};

/// The compressor merges two clusters: all receivers of `cluster` move to cluster `into`. `MovesTried`
/// reports whether the merge remains.
struct ClusterMerge {
    std::size_t cluster, into;
    double loss; ///< expected increase of `ClusteringRound::cost`; may be negative
};

/// Decision about all merges and splits since the previous `ClusteringRound` or `MovesTried`. (At its start,
/// a trial of a search also splits or merges clusters to reach its number of clusters. These moves always
/// remain, and a `ClusteringRound` follows them instead of this event.)
struct MovesTried {
    /// `ClusteringRound::cost` before the merges and splits, and after these moves plus some rounds of
    /// clustering.
    double cost_before, cost_after;
    /// True: the merges and splits remain, because the cost decreased by more than a small fraction. False:
    /// the compressor reverts all of them.
    bool kept;
};

/// One round has ended in which the compressor chose the codes of receivers (cluster and quantised weights)
/// for given rows of clusters, and the rows for given codes.
struct CodingRound {
    /// True: the rows of clusters are rounded as in the file. If `CompressOptions` request rounded rows, only
    /// rounds with true can become the result. If the options request float32 rows, always false.
    bool rounded;
    /// Squared error after the round, weighted as in docs/math.md, eq. 28c: close to the squared `lit_rms`.
    /// With lamps: the error E of eq. 28b.
    double error;
};

/// One compression within a search for a budget (`prt/compress/search.h`). The search reports it after the
/// events of that compression.
struct SearchTrial {
    /// True: the compression used few rounds and did not reduce jumps. All errors below, `jump` included, are
    /// then estimates of the errors after complete compression.
    bool draft = false;
    /// `clusters`: number of clusters that the search requested. `payload_bytes`: bytes per receiver that a
    /// game binds, without bases (`CompressStatistics::bytes_per_receiver`).
    int clusters = 0, payload_bytes = 0;
    /// `CompressStatistics::error`: the maximum of the expected `lit_rms` under the metric, `sky_contrast`
    /// and `lamp_contrast`.
    double lit_rms = 0;
    /// Maximum of the expected `lit_rms` under the metric, and of the `lit_rms` under each of `Budget::skies`
    /// at its worst rotation about +Y. Does not include contrast errors.
    double worst_lit_rms = 0;
    double sky_contrast = 0;  ///< `CompressStatistics::sky_contrast`
    double lamp_contrast = 0; ///< `CompressStatistics::lamp_contrast`
    double jump = 0;          ///< `ClusterJumps::percentile_99`; 0 without `Budget::max_jump`
    /// `payload_bytes`, plus the bytes of all bases divided by the number of receivers.
    double bytes_per_vertex = 0;
    double operations = 0; ///< `CompressStatistics::operations`: mean number of multiply-adds per receiver
    double seconds = 0;    ///< duration of the compression, without the measurement of `worst_lit_rms` and
                           ///< `jump`
};

/// Any event of the compressor.
using CompressEvent = std::variant<ClustersSeeded, ClusteringRound, ClusterSplit, ClusterMerge, MovesTried,
                                   CodingRound, SearchTrial>;

/// Function that receives each event, in order, from the thread that called the compressor. Empty: no events.
using CompressTrace = std::function<void(const CompressEvent&)>;

} // namespace prt
