#pragma once

#include "surface/fit_equations.h"

#include <memory>
#include <span>

namespace prt {

/// Solves (M + R) x = b, with M_ij = Σ_s a_s φ_i φ_j and xᵀ R x = Σ_e w_e A_e bend_e(x)². Solving is
/// thread-safe.
class FitSolver {
public:
    /// `bend_weights` [bends]: w_e, what bending costs against squared error over the surface.
    FitSolver(const FitEquations& equations, std::span<const float> bend_weights);
    ~FitSolver();
    FitSolver(FitSolver&&) noexcept;
    FitSolver& operator=(FitSolver&&) noexcept;

    /// Norms of the residual, weighted by the inverse diagonal, over that of b: less changes no error of the
    /// surface in four digits; what tells noise and bends; and what filters noise.
    static constexpr double kPrecise = 1e-5, kEstimate = 1e-3, kRough = 3e-3;

    /// Replaces b by x, [unknowns][stride]; zero where no sample tells. Deterministic, whatever the threads.
    void solve(std::span<float> b_then_x, std::size_t stride, int threads, double tolerance = kPrecise) const;
    void solve(std::span<double> b_then_x, std::size_t stride, int threads,
               double tolerance = kPrecise) const;

private:
    struct System;
    std::unique_ptr<const System> system_;
};

} // namespace prt
