#pragma once

// Solver of the equations of a surface fit.

#include "bake/surface_fit/fit_equations.h"

#include <memory>
#include <span>

namespace prt {

/// Solves (M + R) x = b, with M_ij = Σ_s a_s φ_i φ_j and xᵀ R x = Σ_e w_e A_e d_e(x)², where d_e is a second
/// difference. Solving is thread-safe.
class FitSolver {
public:
    /// `smoothness_weights` [second differences]: w_e, the cost of second differences relative to the squared
    /// error over the surface.
    FitSolver(const FitEquations& equations, std::span<const float> smoothness_weights);
    ~FitSolver();
    FitSolver(FitSolver&&) noexcept;
    FitSolver& operator=(FitSolver&&) noexcept;

    /// Tolerances of the norm of the residual, weighted by the inverse diagonal, relative to that of b.
    /// kPrecise changes no error over the surface in four digits; kEstimate is for estimating noise and
    /// second differences; kRough is for filtering noise.
    static constexpr double kPrecise = 1e-5, kEstimate = 1e-3, kRough = 3e-3;

    /// Replaces b by x, [unknowns][stride]; zero for unknowns without samples. Deterministic for any number
    /// of threads.
    void solve(std::span<float> b_then_x, std::size_t stride, int threads, double tolerance = kPrecise) const;
    void solve(std::span<double> b_then_x, std::size_t stride, int threads,
               double tolerance = kPrecise) const;

private:
    struct System;
    std::unique_ptr<const System> system_;
};

} // namespace prt
