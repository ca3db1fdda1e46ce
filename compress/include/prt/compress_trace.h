#pragma once

// Events that the compressor reports about its progress: `CompressOptions::trace`. Experimental: events may
// change between versions.

#include <cstddef>
#include <functional>
#include <variant>

namespace prt {

/// Initial clusters by k-means++ and Lloyd's iteration, over `axes` axes of the frame.
struct ClustersSeeded {
    std::size_t clusters, axes;
};

/// A round of clustered PCA before weights are quantised. Costs are squared, weighted errors (docs/math.md,
/// eq. 28c), including expected quantisation loss and multipliers.
struct ClusteringRound {
    int component_limit;
    double cost;
};

/// Split of a cluster: points on one side of its mean along the first direction move to `into`, which a merge
/// has emptied.
struct ClusterSplit {
    std::size_t cluster, into;
    double gain; ///< expected decrease of the cost
};

/// Merge of a cluster: all its points move to `into`.
struct ClusterMerge {
    std::size_t cluster, into;
    double loss; ///< expected increase of the cost
};

/// Result of the splits and merges since the previous event of this type, after some rounds of clustering.
/// They are kept if the cost decreased.
struct MovesTried {
    double cost_before, cost_after;
    bool kept;
};

/// A round of alternation between codes and clusters.
struct CodingRound {
    bool rounded; ///< true: bases are rounded as in the file; only such results may be kept
    double error; ///< squared error, weighted as in docs/math.md, eq. 28c: close to the squared lit_rms
};

/// One trial of a search for a budget (`prt/search.h`), reported after the events of its compression.
struct SearchTrial {
    bool draft = false;                  ///< true: few rounds without seams; the final error is estimated
    int clusters = 0, payload_bytes = 0; ///< `bytes_per_receiver`
    double lit_rms = 0;       ///< expected under the metric, or the maximum contrast error if that is larger
    double worst_lit_rms = 0; ///< maximum of `lit_rms` and the errors under the skies of the budget
    double sky_contrast = 0;  ///< `CompressStatistics::sky_contrast`
    double lamp_contrast = 0; ///< `CompressStatistics::lamp_contrast`
    double jump = 0;          ///< maximum jump among those that the budget limits (`Budget::max_jump`)
    double bytes_per_vertex = 0; ///< payload and bases
    double operations = 0;       ///< `CompressStatistics::operations`
    double seconds = 0;
};

/// Any event of the compressor.
using CompressEvent = std::variant<ClustersSeeded, ClusteringRound, ClusterSplit, ClusterMerge, MovesTried,
                                   CodingRound, SearchTrial>;

/// Called for each event, in order, from the compressing thread. May be empty.
using CompressTrace = std::function<void(const CompressEvent&)>;

} // namespace prt
