// How weights share their bits.

#include "compress/clusters/component_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace prt {
namespace {

double density(double x) {
    return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}

/// Integral of (x - y)² density(x) over one cell, by Gauss's rule of three points.
double cell_error(double begin, double step) {
    const double middle = begin + 0.5 * step, off = 0.5 * step * std::sqrt(0.6);
    return step * (5 * off * off * density(middle - off) + 5 * off * off * density(middle + off)) / 18;
}

/// Returns the mean squared error from `begin` to infinity, in closed form.
double tail_error(double begin, double y) {
    const double beyond = 0.5 * std::erfc(begin / std::numbers::sqrt2);
    return (1 + y * y) * beyond + (begin - 2 * y) * density(begin);
}

/// Returns the mean squared error of a Gaussian of variance 1 quantised to 2^bits levels with spacing `step`,
/// by quadrature.
double quantiser_error(int bits, double step) {
    const int half = 1 << (bits - 1);
    double error = tail_error((half - 1) * step, (half - 0.5) * step);
    for (int i = 0; i + 1 < half; ++i)
        error += cell_error(i * step, step);
    return 2 * error;
}

/// By golden sections of the logarithm of the step.
double best_quantiser_error(int bits) {
    double low = std::log(1e-5), high = std::log(4.0);
    for (int i = 0; i < 60; ++i) {
        const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
        if (quantiser_error(bits, std::exp(a)) < quantiser_error(bits, std::exp(b)))
            high = b;
        else
            low = a;
    }
    return quantiser_error(bits, std::exp(low));
}

TEST(ComponentPlan, PredictsTheBestUniformQuantizer) {
    for (int bits = 1; bits <= kMaxWeightBits; ++bits) {
        const ComponentPlan plan =
            plan_components(std::vector<double>{1.0}, 1, {.component_limit = 1, .bits = bits});
        ASSERT_EQ(plan.bits, std::vector<std::uint8_t>{static_cast<std::uint8_t>(bits)});
        const double expected = best_quantiser_error(bits);
        EXPECT_NEAR(plan.error, expected, 0.03 * expected) << bits;
    }
}

} // namespace
} // namespace prt
