#pragma once

// Smoothness weights of a surface fit.

#include "bake/surface_fit/fit_equations.h"

#include <span>
#include <vector>

namespace prt {

/// Smoothness weight if nothing is known about the light, and for an initial fit, whose error should contain
/// only noise.
inline constexpr float kPlainSmoothnessWeight = 0.02f, kFirstSmoothnessWeight = 0.003f;

/// Returns weights of second differences [second differences] that distinguish light from the noise of rays,
/// by empirical Bayes: noise over signal around each edge. `x` is an initial fit. `noise` [unknowns][stride]
/// is the solution for its residuals with random signs per independent group of samples (the wild bootstrap
/// of C. F. J. Wu, 1986), which has the magnitude of the noise in x.
std::vector<float> smoothness_weights(const FitEquations& equations, std::span<const float> x,
                                      std::span<const float> noise, std::size_t stride);

} // namespace prt
