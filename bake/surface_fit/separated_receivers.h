#pragma once

// Separates vertices at one position that have different light.

#include "bake/surface_fit/fit_equations.h"
#include "bake/surface_fit/value_limits.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Separates receivers that share an entry of `alike` if the light of their samples differs by more than
/// noise, for example on both sides of a wall on a floor. `equations` have one unknown per receiver, `values`
/// are the test values of their samples, and `rays` is the number of rays per sample.
std::vector<std::uint32_t> separated(std::vector<std::uint32_t> alike, const FitEquations& equations,
                                     const TestValues& tests, std::span<const float> values, int rays);

} // namespace prt
