#pragma once

#include "coding/weight_coding.h"
#include "metric/frame.h"
#include "prt/clustered_transfer.h"

namespace prt {

/// How the finished clusters are written.
struct Encoding {
    WeightFormat format = WeightFormat::packed;
    int cluster_bits = 0; ///< 0: as few as do
    RowSteps steps = {};  ///< clusters were rounded to them and are written in code; none: as float32
};

/// The frame as a file holds it: its axes are rounded so that this adds a squared error of about
/// `most_error`, were it not made good by the coordinates. `frame` then holds the rounded axes, and the
/// analysis that belongs to them.
CodedBases code_frame(Frame& frame, const LightMetric& metric, double most_error);

/// The transfer that `clusters` and `codes` stand for in the space of `frame`. `coded_frame` is what
/// code_frame made of it, where there is a step; `guides` are scaled as the clusters see them.
ClusteredTransfer encode(const Frame& frame, const CodedBases& coded_frame, const QuantisedClusters& clusters,
                         const Codes& codes, const GuideCoordinates& guides, const Encoding& encoding);

} // namespace prt
