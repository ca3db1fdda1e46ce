#pragma once

// Encoding of clusters and codes to transfer.

#include "compress/coding/weight_coding.h"
#include "compress/metric/frame.h"
#include "prt/core/clustered_transfer.h"

namespace prt {

/// Output format of clusters.
struct Encoding {
    WeightFormat format = WeightFormat::packed;
    int cluster_bits = 0; ///< 0: the minimum
    RowSteps steps = {};  ///< steps of the rounded clusters, which are written in code; empty: as float32
};

/// Converts a frame to its form in a file: rounds its axes so that this adds a squared error of about
/// `error_limit` if coordinates did not compensate it. `frame` then has the rounded axes, and the matching
/// analysis.
CodedBases code_frame(Frame& frame, const LightMetric& metric, double error_limit);

/// Returns the transfer that `clusters` and `codes` represent in the space of `frame`. `coded_frame` is the
/// result of code_frame, if there is a step; `predictors` are scaled as the clusters use them.
ClusteredTransfer encode(const Frame& frame, const CodedBases& coded_frame, const QuantisedClusters& clusters,
                         const Codes& codes, const PredictorCoordinates& predictors,
                         const Encoding& encoding);

} // namespace prt
