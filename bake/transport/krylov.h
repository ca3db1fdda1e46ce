#pragma once

// All bounces at once: x = sum over k of K^k b as the solution of (I - K) x = b, by GMRES (Y. Saad, M. H.
// Schultz, SIAM J. Sci. Stat. Comput. 7, 1986). In an almost closed room K has one eigenvalue next to 1: a
// sum over bounces needs the number of bounces after which light has left the room; Krylov methods need only
// one or two steps more than elsewhere.

#include <cstddef>
#include <functional>
#include <span>

namespace prt {

/// The operator K on [rows][columns].
struct ColumnOperator {
    /// Computes to = K from. `from` may be overwritten.
    std::function<void(std::span<float> from, std::span<float> to)> apply;
    /// Computes r = b - x + K x, rounded to floats once at the end: an eigenvalue next to 1 amplifies the
    /// rounding errors of float sums.
    std::function<void(std::span<const float> b, std::span<const float> x, std::span<float> r)> residual;
};

struct KrylovOptions {
    std::size_t columns = 1; ///< solved in parallel, independent of each other
    /// Target error of the solution relative to its largest element. A round of steps changes the solution by
    /// the detected error, and leaves a small share of it.
    double tolerance = 1e-5;
    int steps = 32; ///< maximum steps per round; each needs the memory of a solution
    int rounds = 6; ///< maximum number of rounds
    int threads = 0;
    std::function<void()> check; ///< called between steps; may throw
};

struct KrylovResult {
    int applications = 0; ///< number of applications of K
    double remaining = 0; ///< estimated maximum error of an element, relative to the largest element
    bool converged = false;
};

/// Replaces b, [rows][columns], by x. Deterministic for any number of threads.
KrylovResult solve_fixed_point(const ColumnOperator& k, std::span<float> b_then_x,
                               const KrylovOptions& options);

} // namespace prt
