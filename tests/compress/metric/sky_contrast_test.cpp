// Contrast under skies against sums over receivers.

#include "compress/metric/sky_contrast.h"

#include "prt/core/sh.h"
#include "prt/core/transfer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

/// Receivers under uniform light alone, by their light; white noise is their metric.
Transfer receivers_of(const std::vector<float>& light) {
    return {layout_of_one(1, 1), light};
}

TEST(SkyContrast, CostsDecreaseWithTheLight) {
    const Transfer t = receivers_of({1, 4, 0.25f});
    const std::vector<float> significance = {0.5f, 0.25f, 0.25f};
    const LightMetric metric{t.layout, {1}};
    const SkyContrast contrast(t, significance, metric, 1);
    const double a = 0.1, mean_square = 0.5 + 0.25 * 16 + 0.25 / 16; // the logarithmic mean is 1
    const std::vector<float> costs = contrast.costs();
    const double light[] = {1, 4, 0.25};
    for (std::size_t p = 0; p < 3; ++p)
        EXPECT_NEAR(costs[p], 0.7 + 0.3 * mean_square / std::pow(light[p] + a, 2), 1e-4) << p;
}

TEST(SkyContrast, IsTheRootOfTheMeanSquaredErrorOverTheLight) {
    const Transfer t = receivers_of({1, 4, 0.25f}), other = receivers_of({1.1f, 3, 0.25f});
    const std::vector<float> significance = {0.5f, 0.25f, 0.25f};
    const LightMetric metric{t.layout, {1}};
    const double expected = std::sqrt(0.5 * std::pow(0.1 / 1.1, 2) + 0.25 * std::pow(1 / 4.1, 2));
    EXPECT_NEAR(SkyContrast(t, significance, metric, 1).contrast(other), expected, 1e-6);
}

TEST(SkyContrast, DarknessIsZeroWithCostsOfOne) {
    const Transfer t = receivers_of({0, 0});
    const std::vector<float> significance = {0.5f, 0.5f};
    const LightMetric metric{t.layout, {1}};
    const SkyContrast contrast(t, significance, metric, 1);
    EXPECT_EQ(contrast.costs(), (std::vector<float>{1, 1}));
    EXPECT_EQ(contrast.contrast(t), 0);
}

} // namespace
} // namespace prt
