#pragma once

// Settings that are fixed while the number of clusters varies.

#include "prt/compress/compress.h"

#include <compare>
#include <limits>

namespace prt {

/// Settings along which a search varies the number of clusters.
struct PayloadConfig {
    int payload = 1; ///< 32-bit words per receiver, or groups of four floats
    bool bases_count = true;
    int component_limit = std::numeric_limits<int>::max(); ///< lowered if the budget is very small
    PredictorChoice predictors = PredictorChoice::normal;
    double basis_share = -1; ///< CompressOptions::basis_share; negative: the tuned value
    bool finished = false;   ///< with all rounds and seams; drafts only steer the search
    friend auto operator<=>(const PayloadConfig&, const PayloadConfig&) = default;
};

/// Returns the bytes per receiver of a payload; with floats, four of them hold the cluster.
double payload_bytes(WeightFormat format, int payload);

/// Returns the words of a preset, or the groups of four that its components need.
int payload_of(const WeightCoding& preset, std::size_t dimension);

/// Returns the number of rows that predictors add to a mean, if the surface has the attributes.
int predictor_rows_of(PredictorChoice predictors, const ReceiverSurface& surface);

} // namespace prt
