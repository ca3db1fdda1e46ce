// Tests the solver of infinite bounces with operators whose solutions are known.

#include "bake/transport/krylov.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace prt {
namespace {

constexpr std::size_t kRows = 99, kColumns = 3;

/// Column c of K is factors[c] times the identity, but `swaps` exchanges neighbours: eigenvalues ± factor.
ColumnOperator scaled(std::vector<float> factors, bool swaps) {
    const auto element = [factors, swaps](std::span<const float> from, std::size_t i) {
        const std::size_t row = i / kColumns, c = i % kColumns;
        const std::size_t other = swaps ? (row ^ 1U) : row;
        return static_cast<double>(factors[c]) *
               (other < kRows ? static_cast<double>(from[other * kColumns + c]) : 0.0);
    };
    return {.apply =
                [element](std::span<float> from, std::span<float> to) {
                    for (std::size_t i = 0; i < to.size(); ++i)
                        to[i] = static_cast<float>(element(from, i));
                },
            .residual =
                [element](std::span<const float> b, std::span<const float> x, std::span<float> r) {
                    for (std::size_t i = 0; i < r.size(); ++i)
                        r[i] = static_cast<float>(static_cast<double>(b[i]) - static_cast<double>(x[i]) +
                                                  element(x, i));
                }};
}

std::vector<float> right_side() {
    std::vector<float> b(kRows * kColumns);
    for (std::size_t i = 0; i < b.size(); ++i)
        b[i] = static_cast<float>(std::sin(1.7 * static_cast<double>(i)) + 0.3);
    return b;
}

TEST(Krylov, IsExactIfOneStepSolvesAColumn) {
    // Light that is fully absorbed, light that is almost fully reflected, and darkness.
    for (const std::vector<float>& factors :
         {std::vector<float>{0, 0, 0}, {1e-9F, 0.5F, 0}, {0, 0.99F, 1e-6F}}) {
        std::vector<float> x = right_side();
        for (std::size_t row = 0; row < kRows; ++row)
            x[row * kColumns + 2] = 0;
        const std::vector<float> b = x;
        const KrylovResult result =
            solve_fixed_point(scaled(factors, false), x, {.columns = kColumns, .check = {}});
        EXPECT_TRUE(result.converged);
        for (std::size_t i = 0; i < x.size(); ++i)
            EXPECT_NEAR(x[i], b[i] / (1 - factors[i % kColumns]), 1e-5 * 130) << i;
    }
}

TEST(Krylov, StopsAtRoundingErrors) {
    // All elements are equal and are permuted cyclically: the norm of a column differs from 1 by up to an
    // epsilon, and its residual is parallel to itself.
    for (std::size_t rows = 1; rows < 200; ++rows) {
        std::vector<float> x(rows * kColumns, 1.0F);
        solve_fixed_point(scaled({0, 0, 0}, false), x, {.columns = kColumns, .check = {}});
        for (const float value : x)
            EXPECT_NEAR(value, 1.0F, 1e-5F) << rows;
    }
}

TEST(Krylov, SolvesColumnsOfDifferentDepthSideBySide) {
    const std::vector<float> factors = {0.9F, 0, 0.5F}, b = right_side();
    std::vector<float> x = b;
    const KrylovResult result =
        solve_fixed_point(scaled(factors, true), x, {.columns = kColumns, .check = {}});
    EXPECT_TRUE(result.converged);
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t c = 0; c < kColumns; ++c) {
            const std::size_t other = row ^ 1U;
            const double f = static_cast<double>(factors[c]),
                         own = static_cast<double>(b[row * kColumns + c]),
                         across = other < kRows ? static_cast<double>(b[other * kColumns + c]) : 0.0,
                         expected = other < kRows ? (own + f * across) / (1 - f * f) : own;
            EXPECT_NEAR(x[row * kColumns + c], expected, 1e-4) << row << " " << c;
        }
}

} // namespace
} // namespace prt
