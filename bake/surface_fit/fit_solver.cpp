// Solves the normal equations by conjugate gradients with the Jacobi preconditioner (Hestenes and Stiefel
// 1952), several columns at a time, so that the matrix is read once for all of them. The diagonal of a mass
// matrix is a good approximation, so that a few dozen steps suffice, which is faster than a factorisation.

#include "bake/surface_fit/fit_solver.h"

#include "runtime/core/support/parallel.h"

#include <Eigen/SparseCore>

#include <algorithm>

namespace prt {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr std::size_t kColumns = 8; ///< number of columns solved together
using Columns [[gnu::vector_size(kColumns * sizeof(double))]] = double;

constexpr int kMaxSteps = 500; ///< needed for needle-shaped triangles

Matrix normal_matrix(const FitEquations& equations, std::span<const float> smoothness_weights) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double> diagonal(equations.unknowns, 0);
    const auto add = [&](std::uint32_t i, std::uint32_t j, double value) {
        if (i == j)
            diagonal[i] += value;
        else
            entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
    };
    // A triangle with one sample and no shared edge takes the value of the sample everywhere.
    constexpr double kSlope = 1e-5;
    for (const FitRow& row : equations.rows)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (row.unknowns[i] != kNoReceiver && row.unknowns[j] != kNoReceiver)
                    add(row.unknowns[i], row.unknowns[j],
                        static_cast<double>(row.area) *
                            (static_cast<double>(row.shares[i]) * static_cast<double>(row.shares[j]) +
                             kSlope * (i == j ? 2.0 : -1.0)));
    for (std::size_t e = 0; e < equations.second_differences.size(); ++e) {
        const SecondDifference& second_difference = equations.second_differences[e];
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                add(second_difference.unknowns[i], second_difference.unknowns[j],
                    static_cast<double>(smoothness_weights[e]) * static_cast<double>(second_difference.area) *
                        static_cast<double>(second_difference.factors[i]) *
                        static_cast<double>(second_difference.factors[j]));
    }
    constexpr double kRidge = 1e-9; // relative to the diagonal: undetermined unknowns stay finite
    for (std::size_t i = 0; i < diagonal.size(); ++i)
        entries.emplace_back(static_cast<int>(i), static_cast<int>(i),
                             diagonal[i] > 0 ? diagonal[i] * (1 + kRidge) : 1.0);
    const auto count = static_cast<Eigen::Index>(equations.unknowns);
    Matrix matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

} // namespace

struct FitSolver::System {
    Matrix matrix;
    std::vector<double> inverse_diagonal, inverse_sum; ///< [unknowns] reciprocals of the diagonal and of the
                                                       ///< row's sum; 0 if the sum is not positive

    System(const FitEquations& equations, std::span<const float> smoothness_weights)
        : matrix(normal_matrix(equations, smoothness_weights)) {
        for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
            double sum = 0, diagonal = 0;
            for (Matrix::InnerIterator entry(matrix, i); entry; ++entry) {
                sum += entry.value();
                diagonal += entry.col() == i ? entry.value() : 0;
            }
            inverse_diagonal.push_back(1 / diagonal);
            inverse_sum.push_back(sum > 1e-6 * diagonal ? 1 / sum : 0);
        }
    }

    std::size_t unknowns() const { return inverse_diagonal.size(); }
    Columns row_times(std::size_t i, std::span<const Columns> x) const;
    /// Replaces b by x.
    void solve(std::span<Columns> b_then_x, double tolerance) const;
    template <class Value>
    void solve_all(std::span<Value> b_then_x, std::size_t stride, int threads, double tolerance) const;
};

Columns FitSolver::System::row_times(std::size_t i, std::span<const Columns> x) const {
    const int* const first = matrix.outerIndexPtr();
    const int* const columns = matrix.innerIndexPtr();
    const double* const values = matrix.valuePtr();
    Columns sum{};
    for (int e = first[i]; e < first[i + 1]; ++e)
        sum += values[e] * x[static_cast<std::size_t>(columns[e])];
    return sum;
}

void FitSolver::System::solve(std::span<Columns> b_then_x, double tolerance) const {
    const std::size_t count = unknowns();
    std::vector<Columns> x(count), residual(b_then_x.begin(), b_then_x.end()), way(count), moved(count);
    Columns squared_b{}, squared{};
    for (std::size_t i = 0; i < count; ++i) {
        squared_b += residual[i] * residual[i] * inverse_diagonal[i];
        x[i] = residual[i] * inverse_sum[i]; // mean of the samples around the unknown
    }
    for (std::size_t i = 0; i < count; ++i) {
        residual[i] -= row_times(i, x);
        way[i] = residual[i] * inverse_diagonal[i];
        squared += residual[i] * way[i];
    }
    const auto done = [&] {
        for (std::size_t c = 0; c < kColumns; ++c)
            if (squared[c] > tolerance * tolerance * squared_b[c])
                return false;
        return true;
    };
    const auto ratio = [](const Columns& a, const Columns& b) { // 0 for a column that is solved exactly
        Columns result{};
        for (std::size_t c = 0; c < kColumns; ++c)
            result[c] = b[c] > 0 ? a[c] / b[c] : 0;
        return result;
    };
    for (int step = 0; step < kMaxSteps && !done(); ++step) {
        Columns along{};
        for (std::size_t i = 0; i < count; ++i) {
            moved[i] = row_times(i, way);
            along += way[i] * moved[i];
        }
        const Columns length = ratio(squared, along), before = squared;
        squared = Columns{};
        for (std::size_t i = 0; i < count; ++i) {
            x[i] += length * way[i];
            residual[i] -= length * moved[i];
            squared += residual[i] * residual[i] * inverse_diagonal[i];
        }
        const Columns rotation = ratio(squared, before);
        for (std::size_t i = 0; i < count; ++i)
            way[i] = residual[i] * inverse_diagonal[i] + rotation * way[i];
    }
    std::ranges::copy(x, b_then_x.begin());
}

template <class Value>
void FitSolver::System::solve_all(std::span<Value> b_then_x, std::size_t stride, int threads,
                                  double tolerance) const {
    parallel_for((stride + kColumns - 1) / kColumns, 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<Columns> x(unknowns());
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t from = block * kColumns, width = std::min(kColumns, stride - from);
            std::ranges::fill(x, Columns{});
            for (std::size_t i = 0; i < x.size(); ++i)
                for (std::size_t c = 0; c < width; ++c)
                    x[i][c] = static_cast<double>(b_then_x[i * stride + from + c]);
            solve(x, tolerance);
            for (std::size_t i = 0; i < x.size(); ++i)
                for (std::size_t c = 0; c < width; ++c)
                    b_then_x[i * stride + from + c] = static_cast<Value>(x[i][c]);
        }
    });
}

FitSolver::FitSolver(const FitEquations& equations, std::span<const float> smoothness_weights)
    : system_(std::make_unique<const System>(equations, smoothness_weights)) {}

FitSolver::~FitSolver() = default;
FitSolver::FitSolver(FitSolver&&) noexcept = default;
FitSolver& FitSolver::operator=(FitSolver&&) noexcept = default;

void FitSolver::solve(std::span<float> b_then_x, std::size_t stride, int threads, double tolerance) const {
    system_->solve_all(b_then_x, stride, threads, tolerance);
}

void FitSolver::solve(std::span<double> b_then_x, std::size_t stride, int threads, double tolerance) const {
    system_->solve_all(b_then_x, stride, threads, tolerance);
}

} // namespace prt
