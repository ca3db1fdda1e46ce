#pragma once

// What the compressor tells whoever wants to know how it came to its result: `CompressOptions::trace`.
// Experimental: events may come and go between versions.

#include <cstddef>
#include <functional>
#include <variant>

namespace prt {

/// The start: clusters by k-means++ and Lloyd's iteration, over so many axes of the frame.
struct ClustersSeeded {
    std::size_t clusters, axes;
};

/// A round of clustered PCA before weights are quantised. Costs are squared and weighted errors
/// (docs/math.md, eq. 28c), with what quantisation is expected to lose, and prices.
struct ClusteringRound {
    int most_components;
    double cost;
};

/// A cluster whose points beyond its mean along the first direction go to `into`, which a merge has emptied.
struct ClusterSplit {
    std::size_t cluster, into;
    double gain; ///< expected fall of the cost
};

/// A cluster whose points all go to `into`.
struct ClusterMerge {
    std::size_t cluster, into;
    double loss; ///< expected rise of the cost
};

/// A sweep of the splits and merges since the last such event, after some rounds: kept where the cost fell.
struct MovesTried {
    double cost_before, cost_after;
    bool kept;
};

/// A round of codes and clusters in turn.
struct CodingRound {
    bool rounded; ///< with bases rounded as they will be written; only such results may be kept
    double error; ///< squared, weighted as docs/math.md, eq. 28c: near the squared lit_rms
};

/// One try of a search for a budget (`prt/search.h`), after the events of its own compression.
struct SearchTrial {
    bool draft = false;                  ///< few rounds and no seams: what more of them lead to is estimated
    int clusters = 0, payload_bytes = 0; ///< `bytes_per_receiver`
    double lit_rms = 0; ///< expected under the metric, or the greatest contrast error if that is greater
    double worst_lit_rms = 0;    ///< the greatest of that and of those under skies that are promised
    double sky_contrast = 0;     ///< `CompressStatistics::sky_contrast`
    double lamp_contrast = 0;    ///< the same of `lamp_contrast`
    double jump = 0;             ///< the greatest that is promised (`Budget::max_jump`)
    double bytes_per_vertex = 0; ///< payload and bases
    double operations = 0;       ///< `CompressStatistics::operations`
    double seconds = 0;
};

using CompressEvent = std::variant<ClustersSeeded, ClusteringRound, ClusterSplit, ClusterMerge, MovesTried,
                                   CodingRound, SearchTrial>;

/// Is called for each event, in order, from the thread that compresses. Empty: nothing is told.
using CompressTrace = std::function<void(const CompressEvent&)>;

} // namespace prt
