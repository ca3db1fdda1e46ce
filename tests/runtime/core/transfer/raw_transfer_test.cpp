// Tests exit radiance of raw transfer.

#include "prt/core/transfer.h"

#include "prt/core/sh.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

/// Returns transfer in which all numbers differ, by receiver, channel and coefficient.
Transfer counted_transfer(int order, int channels, std::size_t receivers) {
    Transfer transfer = zero_transfer(order, channels, receivers);
    float next = 1;
    for (float& v : transfer.vectors)
        v = next++;
    return transfer;
}

TEST(RawTransfer, IsMultipliedWithTheLightOfItsChannel) {
    const Light light{2, {{1, 2, 3}, {0, -1, 4}, {5, 0, 1}, {2, 2, -2}}};
    // Receiver 1 of white transfer has 5, 6, 7, 8; colored transfer has 13 to 16, 17 to 20, 21 to 24.
    EXPECT_EQ(exit_radiance(counted_transfer(2, 1, 2), light)[1],
              glm::vec3(5 + 35 + 16, 10 - 6 + 16, 15 + 24 + 7 - 16));
    EXPECT_EQ(exit_radiance(counted_transfer(2, 3, 2), light)[1],
              glm::vec3(13 + 75 + 32, 34 - 18 + 40, 63 + 88 + 23 - 48));
}

TEST(RawTransfer, IgnoresMissingBandsOfTheLight) {
    const Light light{2, {{1, 2, 3}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}}};
    EXPECT_EQ(exit_radiance(counted_transfer(1, 3, 1), light)[0], glm::vec3(1, 4, 9));
}

TEST(RawTransfer, SeesTheMeanOfItsFirstCoefficientsByArea) {
    const float areas[] = {3, 0, 1};
    // For order 2 the first coefficients are 1, 5, 9; in three channels 1, 5, 9, then 13, 17, 21, then 25,
    // 29, 33.
    EXPECT_NEAR(mean_visibility(counted_transfer(2, 1, 3), areas), (3 * 1 + 9) / 4.0 / kY00, 1e-6);
    EXPECT_NEAR(mean_visibility(counted_transfer(2, 3, 3), areas), (3 * 5 + 29) / 4.0 / kY00, 1e-6);
    const float nothing[] = {0, 0, 0};
    EXPECT_EQ(mean_visibility(counted_transfer(2, 1, 3), nothing), 0);
}

} // namespace
} // namespace prt
