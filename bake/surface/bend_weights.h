#pragma once

#include "surface/fit_equations.h"

#include <span>
#include <vector>

namespace prt {

/// What bending costs where nothing is known of the light; and in a first fit, whose error is to be noise
/// alone.
inline constexpr float kPlainBendWeight = 0.02f, kFirstBendWeight = 0.003f;

/// Weights of bends [bends] that tell light from the noise of rays, empirical Bayes: noise over signal, as it
/// is round each edge. `x` is a first fit, and `noise` [unknowns][stride] what random signs of independent
/// groups of samples make of what it leaves over (the wild bootstrap of C. F. J. Wu, 1986): as large as the
/// noise in x.
std::vector<float> bend_weights(const FitEquations& equations, std::span<const float> x,
                                std::span<const float> noise, std::size_t stride);

} // namespace prt
