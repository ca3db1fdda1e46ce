// Factors the normal equations once by sparse Cholesky decomposition, and substitutes for some columns at a
// time, so that the factor is read once for all of them.

#include "surface/fit_solver.h"

#include "prt/support/error.h"
#include "prt/support/parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>

namespace prt {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

constexpr std::size_t kColumns = 8; ///< substituted together
using Columns [[gnu::vector_size(kColumns * sizeof(double))]] = double;

/// Lower triangle of M + R.
Matrix normal_matrix(const FitEquations& equations, std::span<const float> bend_weights) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double> diagonal(equations.unknowns, 0);
    const auto add = [&](std::uint32_t i, std::uint32_t j, double value) {
        if (i == j)
            diagonal[i] += value;
        else if (i > j)
            entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
    };
    // A triangle of one sample that shares no edge has no other values than that of the sample.
    constexpr double kSlope = 1e-5;
    for (const FitRow& row : equations.rows)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (row.unknowns[i] != kNoReceiver && row.unknowns[j] != kNoReceiver)
                    add(row.unknowns[i], row.unknowns[j],
                        static_cast<double>(row.area) *
                            (static_cast<double>(row.shares[i]) * static_cast<double>(row.shares[j]) +
                             kSlope * (i == j ? 2.0 : -1.0)));
    for (std::size_t e = 0; e < equations.bends.size(); ++e) {
        const Bend& bend = equations.bends[e];
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                add(bend.unknowns[i], bend.unknowns[j],
                    static_cast<double>(bend_weights[e]) * static_cast<double>(bend.area) *
                        static_cast<double>(bend.factors[i]) * static_cast<double>(bend.factors[j]));
    }
    constexpr double kRidge = 1e-9; // of what is there: what nothing tells of stays finite
    for (std::size_t i = 0; i < diagonal.size(); ++i)
        entries.emplace_back(static_cast<int>(i), static_cast<int>(i),
                             diagonal[i] > 0 ? diagonal[i] * (1 + kRidge) : 1.0);
    const auto count = static_cast<Eigen::Index>(equations.unknowns);
    Matrix matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

} // namespace

struct FitSolver::Factor {
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower> ldlt;
    Eigen::VectorXd pivots;

    /// The pattern of `matrix` is known.
    void factor(const Matrix& matrix) {
        ldlt.factorize(matrix);
        if (ldlt.info() != Eigen::Success)
            throw Error("the values of vertices cannot be fitted to the surface");
        pivots = ldlt.vectorD();
    }
    std::size_t unknowns() const { return static_cast<std::size_t>(ldlt.rows()); }
    /// Rows of the factor that unknowns have become.
    const int* order() const { return ldlt.permutationP().indices().data(); }

    /// Replaces b by x, in the factor's order.
    void substitute(std::span<Columns> x) const;
    template <class Value>
    void solve(std::span<Value> values, std::size_t stride, int threads) const;
};

void FitSolver::Factor::substitute(std::span<Columns> x) const {
    const auto& lower = ldlt.matrixL().nestedExpression(); // strictly below its diagonal of ones
    const int* const first = lower.outerIndexPtr();
    const int* const rows = lower.innerIndexPtr();
    const double* const values = lower.valuePtr();
    for (std::size_t j = 0; j < x.size(); ++j)
        for (int e = first[j]; e < first[j + 1]; ++e)
            x[static_cast<std::size_t>(rows[e])] -= values[e] * x[j];
    for (std::size_t j = x.size(); j-- > 0;) {
        Columns sum = x[j] / pivots[static_cast<Eigen::Index>(j)];
        for (int e = first[j]; e < first[j + 1]; ++e)
            sum -= values[e] * x[static_cast<std::size_t>(rows[e])];
        x[j] = sum;
    }
}

template <class Value>
void FitSolver::Factor::solve(std::span<Value> values, std::size_t stride, int threads) const {
    parallel_for((stride + kColumns - 1) / kColumns, 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<Columns> x(unknowns());
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t from = block * kColumns, width = std::min(kColumns, stride - from);
            const auto each = [&](auto&& visit) {
                for (std::size_t i = 0; i < x.size(); ++i)
                    for (std::size_t c = 0; c < width; ++c)
                        visit(x[static_cast<std::size_t>(order()[i])], c, values[i * stride + from + c]);
            };
            each([](Columns& row, std::size_t c, Value& v) { row[c] = static_cast<double>(v); });
            substitute(x);
            each([](Columns& row, std::size_t c, Value& v) { v = static_cast<Value>(row[c]); });
        }
    });
}

FitSolver::FitSolver(const FitEquations& equations, std::span<const float> bend_weights)
    : factor_(std::make_unique<Factor>()) {
    const Matrix matrix = normal_matrix(equations, bend_weights);
    factor_->ldlt.analyzePattern(matrix);
    factor_->factor(matrix);
}

void FitSolver::factor(const FitEquations& equations, std::span<const float> bend_weights) {
    factor_->factor(normal_matrix(equations, bend_weights));
}

FitSolver::~FitSolver() = default;
FitSolver::FitSolver(FitSolver&&) noexcept = default;
FitSolver& FitSolver::operator=(FitSolver&&) noexcept = default;

void FitSolver::solve(std::span<float> b_then_x, std::size_t stride, int threads) const {
    factor_->solve(b_then_x, stride, threads);
}

void FitSolver::solve(std::span<double> b_then_x, std::size_t stride, int threads) const {
    factor_->solve(b_then_x, stride, threads);
}

} // namespace prt
