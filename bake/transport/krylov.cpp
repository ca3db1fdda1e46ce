// Solves for all bounces with restarted GMRES (Saad and Schultz 1986), for many columns in parallel.

#include "bake/transport/krylov.h"

#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace prt {
namespace {

/// One number per column.
using Columns = std::vector<double>;
using Vector = std::vector<float>;

/// Sums and linear combinations of vectors, column by column. Sums use blocks of rows that do not depend on
/// the number of threads.
class ColumnArithmetic {
public:
    ColumnArithmetic(std::size_t rows, std::size_t columns, int threads)
        : rows_(rows), columns_(columns), threads_(threads) {}

    Columns dot(const Vector& a, const Vector& b) const {
        std::vector<double> partial(blocks() * columns_, 0);
        for_elements([&](std::size_t block, std::size_t i, std::size_t c) {
            partial[block * columns_ + c] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
        });
        Columns sums(columns_, 0);
        for (std::size_t i = 0; i < partial.size(); ++i)
            sums[i % columns_] += partial[i];
        return sums;
    }

    Columns norms(const Vector& a) const {
        Columns result = dot(a, a);
        for (double& value : result)
            value = std::sqrt(value);
        return result;
    }

    /// Computes to += factors · a.
    void add(Vector& to, const Columns& factors, const Vector& a) const {
        for_elements([&](std::size_t, std::size_t i, std::size_t c) {
            to[i] += static_cast<float>(factors[c]) * a[i];
        });
    }

    /// Computes a /= divisors; columns with a zero divisor become zero.
    void divide(Vector& a, const Columns& divisors) const {
        for_elements([&](std::size_t, std::size_t i, std::size_t c) {
            a[i] = divisors[c] > 0 ? static_cast<float>(static_cast<double>(a[i]) / divisors[c]) : 0.0f;
        });
    }

    /// Computes to += a. Returns the maximum absolute element of `a` divided by that of `to`.
    double advance(std::span<float> to, const Vector& a) const {
        std::vector<float> changes(blocks(), 0), largest(blocks(), 0);
        for_elements([&](std::size_t block, std::size_t i, std::size_t) {
            to[i] += a[i];
            changes[block] = std::max(changes[block], std::abs(a[i]));
            largest[block] = std::max(largest[block], std::abs(to[i]));
        });
        const float change = *std::max_element(changes.begin(), changes.end()),
                    most = *std::max_element(largest.begin(), largest.end());
        return most > 0 ? static_cast<double>(change / most) : 0;
    }

private:
    static constexpr std::size_t kBlock = 512;
    std::size_t blocks() const { return (rows_ + kBlock - 1) / kBlock; }

    template <class Work>
    void for_elements(Work&& work) const {
        parallel_for(blocks(), 1, threads_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t block = begin; block < end; ++block)
                for (std::size_t row = block * kBlock; row < std::min(rows_, (block + 1) * kBlock); ++row)
                    for (std::size_t c = 0; c < columns_; ++c)
                        work(block, row * columns_ + c, c);
        });
    }

    std::size_t rows_, columns_;
    int threads_;
};

/// The least-squares problem of one column: the Hessenberg matrix, transformed to a triangular matrix by
/// Givens rotations as it grows.
class SmallSystem {
public:
    explicit SmallSystem(double right_side) : right_side_{right_side} {}

    double residual() const { return std::abs(right_side_.back()); }

    /// Adds column j of the Hessenberg matrix, which has j + 2 elements.
    void add(std::vector<double> column) {
        for (std::size_t i = 0; i < rotations_.size(); ++i)
            rotate(rotations_[i], column[i], column[i + 1]);
        const std::size_t j = rotations_.size();
        const double length = std::hypot(column[j], column[j + 1]);
        rotations_.push_back(length > 0 ? Rotation{column[j] / length, column[j + 1] / length}
                                        : Rotation{1, 0});
        rotate(rotations_[j], column[j], column[j + 1]);
        right_side_.push_back(0);
        rotate(rotations_[j], right_side_[j], right_side_[j + 1]);
        triangle_.push_back(std::move(column));
    }

    std::vector<double> solution() const {
        std::vector<double> y(triangle_.size(), 0);
        for (std::size_t i = y.size(); i-- > 0;) {
            double rest = right_side_[i];
            for (std::size_t j = i + 1; j < y.size(); ++j)
                rest -= triangle_[j][i] * y[j];
            y[i] = triangle_[i][i] != 0 ? rest / triangle_[i][i] : 0;
        }
        return y;
    }

private:
    struct Rotation {
        double cosine, sine;
    };
    static void rotate(const Rotation& r, double& a, double& b) {
        const double rotated = r.cosine * a + r.sine * b;
        b = r.cosine * b - r.sine * a;
        a = rotated;
    }

    std::vector<Rotation> rotations_;
    std::vector<std::vector<double>> triangle_; ///< [column][row]
    std::vector<double> right_side_;
};

/// Share of the detected error that remains after a round: 0.005 to 0.02 measured in rooms with pinholes.
constexpr double kMissed = 0.05;

class Gmres {
public:
    Gmres(const ColumnOperator& k, std::size_t rows, const KrylovOptions& options)
        : k_(k), options_(options), with_(rows, options.columns, options.threads) {}

    KrylovResult run(std::span<float> b_then_x) {
        const Vector b(b_then_x.begin(), b_then_x.end());
        std::fill(b_then_x.begin(), b_then_x.end(), 0.0f);
        KrylovResult result;
        // The first round uses the precision of floats; the next ones see its error in the slow modes.
        for (double reduction = 1e-7; !result.converged && rounds_ < options_.rounds; reduction = 1e-2) {
            Vector residual = b;
            if (rounds_++ > 0) {
                k_.residual(b, b_then_x, residual);
                ++applications_;
            }
            const Vector change = round(std::move(residual), reduction);
            result.remaining = kMissed * with_.advance(b_then_x, change);
            result.converged = result.remaining < options_.tolerance;
            result.applications = applications_;
        }
        return result;
    }

private:
    /// Returns (I - K) from.
    Vector applied(const Vector& from) {
        if (options_.check)
            options_.check();
        used_up_ = from;
        Vector to(from.size());
        k_.apply(used_up_, to);
        ++applications_;
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = from[i] - to[i];
        return to;
    }

    /// Returns the correction that reduces the norm of `residual` by `reduction` in every column, or as far
    /// as possible within the maximum number of steps.
    Vector round(Vector residual, double reduction) {
        const std::size_t columns = options_.columns;
        const Columns norms = with_.norms(residual);
        with_.divide(residual, norms);
        std::vector<Vector> basis = {std::move(residual)};
        std::vector<SmallSystem> systems;
        for (const double norm : norms)
            systems.emplace_back(norm);
        const auto reduced = [&] {
            for (std::size_t c = 0; c < columns; ++c)
                if (systems[c].residual() > reduction * norms[c])
                    return false;
            return true;
        };
        for (int step = 0; step < options_.steps && !reduced(); ++step)
            extend(basis, systems);
        Vector change(basis[0].size(), 0.0f);
        std::vector<std::vector<double>> solutions;
        for (const SmallSystem& system : systems)
            solutions.push_back(system.solution());
        for (std::size_t j = 0; j + 1 < basis.size(); ++j) {
            Columns factors(columns);
            for (std::size_t c = 0; c < columns; ++c)
                factors[c] = solutions[c][j];
            with_.add(change, factors, basis[j]);
        }
        return change;
    }

    /// Computes one step of Arnoldi's process with modified Gram-Schmidt orthogonalisation. If only rounding
    /// errors are left of a column, its basis is complete and gets no further direction.
    void extend(std::vector<Vector>& basis, std::vector<SmallSystem>& systems) {
        constexpr double kRounding = 4 * std::numeric_limits<float>::epsilon();
        Vector next = applied(basis.back());
        const Columns before = with_.norms(next);
        std::vector<std::vector<double>> hessenberg(options_.columns);
        for (const Vector& direction : basis) {
            Columns along = with_.dot(next, direction);
            for (std::size_t c = 0; c < along.size(); ++c) {
                hessenberg[c].push_back(along[c]);
                along[c] = -along[c];
            }
            with_.add(next, along, direction);
        }
        Columns norms = with_.norms(next);
        for (std::size_t c = 0; c < norms.size(); ++c) {
            if (norms[c] <= kRounding * before[c])
                norms[c] = 0;
            hessenberg[c].push_back(norms[c]);
            systems[c].add(std::move(hessenberg[c]));
        }
        with_.divide(next, norms);
        basis.push_back(std::move(next));
    }

    const ColumnOperator& k_;
    const KrylovOptions& options_;
    ColumnArithmetic with_;
    Vector used_up_;
    int rounds_ = 0, applications_ = 0;
};

} // namespace

KrylovResult solve_fixed_point(const ColumnOperator& k, std::span<float> b_then_x,
                               const KrylovOptions& options) {
    return Gmres(k, b_then_x.size() / options.columns, options).run(b_then_x);
}

} // namespace prt
