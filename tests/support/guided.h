#pragma once

#include "prt/clustered_transfer.h"

#include <random>
#include <vector>

namespace prt::test {

/// None, each kind, and both.
const std::vector<std::vector<GuideKind>>& sets_of_guides();

/// Puts guides of `kinds` into `bases`, with random rows behind the means, random scales and centers; the
/// rows are not coded any more.
void add_guides(ClusteredBases& bases, const std::vector<GuideKind>& kinds, std::mt19937& random);

/// The same with coordinates for all receivers: unit normals, some of them of 8 bits and some zero, and
/// positions seen from the guide's origin, metres.
void add_guides(ClusteredTransfer& transfer, const std::vector<GuideKind>& kinds, std::mt19937& random);

/// Random code of as many rows as `bases` has, over axes of these `scales`, and the rows that it stands for.
void code_bases(ClusteredBases& bases, const std::vector<float>& scales, std::mt19937& random);

/// T = mean + sum_i (scale_i x_i - center_i) guide_i + sum_j w_j direction_j of receiver `p`, in double.
std::vector<double> decoded_by_hand(const ClusteredTransfer& transfer, std::size_t p);

} // namespace prt::test
