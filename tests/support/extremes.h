#pragma once

// Numbers that break careless arithmetic. Functions that get them must return finite results, or throw
// `prt::Error`.

#include "prt/core/error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace prt::test {

inline constexpr std::array kExtremes = {std::numeric_limits<float>::quiet_NaN(),
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity(),
                                         3e38f,
                                         -3e38f,
                                         1e19f,  // its square overflows floats
                                         1e-45f, // smallest positive float
                                         -1e-38f,
                                         0.0f,
                                         -0.0f,
                                         1.0f};

/// Results of a function, as numbers.
using Numbers = std::vector<double>;

/// Numbers of anything that holds vectors of GLM: colors, directions, pixels.
template <class Vectors>
Numbers numbers_of(const Vectors& vectors) {
    Numbers numbers;
    for (const auto& v : vectors)
        for (int i = 0; i < v.length(); ++i)
            numbers.push_back(static_cast<double>(v[i]));
    return numbers;
}

/// A function with an order and up to two numbers as arguments.
struct ExtremeCase {
    const char* name;
    std::function<Numbers(int order, float x, float y)> call;
};
inline void PrintTo(const ExtremeCase& row, std::ostream* out) {
    *out << row.name;
}

/// The name of a test of one row.
inline std::string name_of(const testing::TestParamInfo<ExtremeCase>& row) {
    return row.param.name;
}

/// Calls `visit` with both ends of the orders and all pairs of extremes.
template <class Visit>
void for_each_extreme(Visit&& visit) {
    for (const int order : {1, 10})
        for (const float x : kExtremes)
            for (const float y : kExtremes)
                visit(order, x, y);
}

/// Expects a finite result, or `Error`, for all of them.
inline void expect_finite_or_refused(const ExtremeCase& row) {
    for_each_extreme([&](int order, float x, float y) {
        if (testing::Test::HasFailure())
            return; // one is enough to find the cause
        try {
            for (const double number : row.call(order, x, y))
                if (!std::isfinite(number))
                    return void(ADD_FAILURE()
                                << "order " << order << ", " << x << " and " << y << ": " << number);
        } catch (const Error&) { // refused
        }
    });
}

} // namespace prt::test
