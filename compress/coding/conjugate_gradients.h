#pragma once

// Linear solver.

#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Returns an approximate x with A x = `right`, starting from 0, for a symmetric positive definite A with
/// `apply(v)` = A v. The matrix is never formed: with 1.5 million receivers and 8 components it would have
/// 10^9 entries. Stops when further changes are below the rounding of weights (tuning.h).
std::vector<float> conjugate_gradients(const std::function<std::vector<float>(std::span<const float>)>& apply,
                                       std::span<const float> inverse_diagonal, std::vector<float> right);

} // namespace prt
