#pragma once

// Alternating optimisation of codes and clusters.

#include "compress/coding/weight_coding.h"
#include "prt/compress/compress_trace.h"

namespace prt {

/// Clusters, and the codes of the points in them.
struct CodedClusters {
    QuantisedClusters clusters;
    Codes codes;
    RowSteps steps; ///< steps of the rounded bases
};

struct AlternationOptions {
    ClusterLists* candidates = nullptr; ///< candidate clusters for the points of each cluster; null:
                                        ///< determined from the extent of codes
    bool stay = false;      ///< points stay in their clusters, because a mean number of components is
                            ///< required
    double basis_share = 0; ///< error that rounding the bases may add, relative to the existing error; 0: no
                            ///< rounding
    int rounds = tuning::kCodingRounds;
    int rounded_from = tuning::kRoundedFrom; ///< the first round with bases rounded as in the file
    CompressTrace trace = {};
    int threads = 0;
};

/// Recomputes the codes of all points for the clusters.
void encode_all(const PointBlocks& points, const AlternationOptions& options, CodedClusters& coded);

/// Alternates before bases are rounded, until the error hardly decreases: for clusters that were found in
/// another space, at most `rounds` times. Clusters whose points other clusters represent nearly as well are
/// moved: they take half of the points of clusters with large errors, and become candidates next to these.
void settle(const PointBlocks& points, std::span<const float> significance, const AlternationOptions& options,
            int rounds, CodedClusters& coded);

/// Alternates between codes for given clusters, and clusters for given codes; finally with rounded bases.
/// Leaves the best of the rounds that can be written.
void alternate(const PointBlocks& points, std::span<const float> significance,
               const AlternationOptions& options, const Progress& progress, CodedClusters& coded);

} // namespace prt
