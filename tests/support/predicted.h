#pragma once

#include "prt/core/clustered_transfer.h"

#include <random>
#include <vector>

namespace prt::test {

/// Returns the sets of predictors: none, each kind, and both.
const std::vector<std::vector<PredictorKind>>& sets_of_predictors();

/// Adds predictors of `kinds` to `bases`, with random rows after the means, random scales and centers; the
/// rows are no longer coded.
void add_predictors(ClusteredBases& bases, const std::vector<PredictorKind>& kinds, std::mt19937& random);

/// Adds predictors with coordinates for all receivers: unit normals, some of them of 8 bits and some zero,
/// and positions relative to the predictor's origin, metres.
void add_predictors(ClusteredTransfer& transfer, const std::vector<PredictorKind>& kinds,
                    std::mt19937& random);

/// Creates random code for the rows of `bases`, over axes of these `scales`, and sets the decoded rows.
void code_bases(ClusteredBases& bases, const std::vector<float>& scales, std::mt19937& random);

/// T = mean + sum_i (scale_i x_i - center_i) predictor_i + sum_j w_j direction_j of receiver `p`, in double.
std::vector<double> decoded_by_hand(const ClusteredTransfer& transfer, std::size_t p);

} // namespace prt::test
