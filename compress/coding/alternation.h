#pragma once

#include "coding/weight_coding.h"
#include "prt/compress_trace.h"

namespace prt {

/// Clusters and what points are coded as in them.
struct CodedClusters {
    QuantisedClusters clusters;
    Codes codes;
    RowSteps steps; ///< of the rounded bases
};

struct AlternationOptions {
    ClusterLists* candidates = nullptr; ///< of the points of each cluster; null: by what codes reach
    bool stay = false;      ///< points stay in their clusters: a mean number of components is promised
    double basis_share = 0; ///< error that rounding the bases may add, as a share of what there is; 0: none
    int rounds = tuning::kCodingRounds;
    int rounded_from =
        tuning::kRoundedFrom; ///< the first round with the bases rounded as they will be written
    CompressTrace trace = {};
    int threads = 0;
};

/// Codes all points anew for the clusters.
void encode_all(const PointBlocks& points, const AlternationOptions& options, CodedClusters& coded);

/// Alternates before bases are rounded, until the error hardly falls: of clusters that were found in another
/// space, at most `rounds` times. Clusters that others serve nearly as well take half of the points of those
/// that err most, and become their neighbours among the candidates.
void settle(const PointBlocks& points, std::span<const float> significance, const AlternationOptions& options,
            int rounds, CodedClusters& coded);

/// Alternates codes, given the clusters, and clusters, given the codes; in the end with the bases
/// rounded. Leaves the best of the rounds that could be written.
void alternate(const PointBlocks& points, std::span<const float> significance,
               const AlternationOptions& options, const Progress& progress, CodedClusters& coded);

} // namespace prt
