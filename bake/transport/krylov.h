#pragma once

// All bounces at once: x = sum over k of K^k b as the solution of (I - K) x = b, by GMRES (Y. Saad, M. H.
// Schultz, SIAM J. Sci. Stat. Comput. 7, 1986). An enclosure that hardly any light leaves has one eigenvalue
// of K next to 1: a sum over bounces takes as many as light takes to get out, Krylov methods a step or two
// more than elsewhere.

#include <cstddef>
#include <functional>
#include <span>

namespace prt {

/// The operator K on [rows][columns].
struct ColumnOperator {
    /// to = K from. `from` may be used up.
    std::function<void(std::span<float> from, std::span<float> to)> apply;
    /// r = b - x + K x, rounded to floats once, at the end: what floats lose of a sum, an eigenvalue next to
    /// 1 makes large.
    std::function<void(std::span<const float> b, std::span<const float> x, std::span<float> r)> residual;
};

struct KrylovOptions {
    std::size_t columns = 1; ///< solved side by side, each on its own
    /// Error of the solution to reach, over its largest element. A round of steps changes the solution by
    /// what was wrong, and leaves a small share of that.
    double tolerance = 1e-5;
    int steps = 32; ///< of a round at most; each takes the memory of the solution
    int rounds = 6; ///< at most
    int threads = 0;
    std::function<void()> check; ///< called between steps; may throw
};

struct KrylovResult {
    int applications = 0; ///< of K
    double remaining = 0; ///< estimated largest error of an element, over the largest element
    bool converged = false;
};

/// Replaces b, [rows][columns], by x. Deterministic, whatever the threads.
KrylovResult solve_fixed_point(const ColumnOperator& k, std::span<float> b_then_x,
                               const KrylovOptions& options);

} // namespace prt
