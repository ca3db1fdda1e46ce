#pragma once

#include <functional>
#include <span>
#include <vector>

namespace prt {

/// An approximate x with A x = `right`, from 0, for a symmetric positive definite A of which `apply(v)` gives
/// A v. The matrix is never formed: with 1.5 million receivers and 8 components it would have 10^9 entries.
/// Ends where weights, which are rounded afterwards, would no longer notice (tuning.h).
std::vector<float> conjugate_gradients(const std::function<std::vector<float>(std::span<const float>)>& apply,
                                       std::span<const float> inverse_diagonal, std::vector<float> right);

} // namespace prt
