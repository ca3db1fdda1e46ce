#pragma once

// Vertices at one place that see different light.

#include "surface/fit_equations.h"
#include "surface/value_limits.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Separates receivers of `alike` where the light of their own samples differs by more than noise, as on both
/// sides of a wall that stands on a floor. `equations` have one unknown for each receiver, `values` are the
/// test values of their samples, and `rays` those of a sample.
std::vector<std::uint32_t> separated(std::vector<std::uint32_t> alike, const FitEquations& equations,
                                     const TestValues& tests, std::span<const float> values, int rays);

} // namespace prt
