// Tests images without suns, and images that break careless arithmetic.

#include "prt/fit/suns.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "support/extremes.h"
#include "support/painted_sky.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;
using test::painted_sky;
using test::Radiance;

std::size_t paying_suns(const Environment& environment, int order = 6) {
    return find_suns(environment, {.order = order}).suns.size();
}

Environment image_of(int width, int height, const glm::vec3& color) {
    Environment e;
    e.image = {
        width, height,
        std::vector<glm::vec3>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), color)};
    return e;
}

TEST(PlainSkies, HaveNoSuns) {
    const std::pair<const char*, Radiance> skies[] = {
        {"constant", [](const glm::dvec3&) { return glm::dvec3(0.7, 0.8, 1); }},
        {"black", [](const glm::dvec3&) { return glm::dvec3(0); }},
        {"clear", test::gradient_sky},
        {"clouds", test::cloudy_sky},
        {"overcast", [](const glm::dvec3& w) { return glm::dvec3(w.y > 0 ? (1 + 2 * w.y) / 3 : 0.1); }},
        {"studio", [](const glm::dvec3& w) { return glm::dvec3(std::exp(8 * (w.z - 1))); }}};
    for (const auto& [name, sky] : skies)
        for (const EnvironmentLayout layout :
             {EnvironmentLayout::lat_long, EnvironmentLayout::cube, EnvironmentLayout::angular})
            EXPECT_EQ(paying_suns(painted_sky(layout, 96, 48, sky, {})), 0u) << name;
}

/// No pixel is brighter than the others, so that even a requested number of suns is not found.
TEST(PlainSkies, YieldNoSunsForARequestedCount) {
    for (const float radiance : {0.0f, 1.0f}) {
        const SunSplit split = find_suns(image_of(64, 32, glm::vec3(radiance)), {.count = 3});
        EXPECT_TRUE(split.suns.empty());
        EXPECT_EQ(split.remainder_share, 1);
        EXPECT_EQ(split.error_with, split.error_without);
    }
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 1), std::pair(1, 6)})
        for (const EnvironmentLayout layout : {EnvironmentLayout::lat_long, EnvironmentLayout::cube}) {
            Environment tiny = image_of(width, height, {3, 2, 1});
            tiny.image.pixels[0] = {1e5f, 1e5f, 1e5f};
            tiny.layout = height == 6 ? layout : EnvironmentLayout::lat_long;
            EXPECT_TRUE(find_suns(tiny, {.count = 3}).suns.empty()) << width << " x " << height;
        }
}

/// A light of 24 degrees is no sun at order 10, which holds it; one as strong of a sixth of that is one.
TEST(PlainSkies, MayContainLightsWithinTheOrder) {
    for (const auto& [degrees, suns] : {std::pair(24.0, 0u), std::pair(4.0, 1u)}) {
        const test::PaintedDisc disc{glm::normalize(glm::dvec3(1, 2, 3)), 0.5 * degrees * pi / 180,
                                     glm::dvec3(2e4 / degrees / degrees)};
        EXPECT_EQ(
            paying_suns(painted_sky(EnvironmentLayout::lat_long, 256, 128, test::gradient_sky, {disc}), 10),
            suns)
            << degrees;
    }
}

TEST(PlainSkies, InvalidSkiesAreRejected) {
    const Environment good = image_of(8, 4, glm::vec3(1));
    EXPECT_THROW(find_suns(good, {.order = 0}), Error);
    EXPECT_THROW(find_suns(good, {.order = 11}), Error);
    EXPECT_THROW(find_suns(good, {.count = -1}), Error);
    EXPECT_THROW(find_suns(image_of(0, 0, glm::vec3(1)), {.count = 1}), Error);
    for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), 3e38f}) {
        Environment e = good;
        e.image.at(3, 2).g = bad;
        EXPECT_THROW(find_suns(e, {.count = 1}), Error) << bad;
    }
}

TEST(PlainSkies, AreFiniteOrRejected) {
    for (const float x : test::kExtremes)
        for (const float y : {0.0f, 1e-45f, 1e30f}) {
            Environment e = image_of(64, 32, glm::vec3(y));
            e.image.at(20, 9) = {x, 0, 1};
            try {
                const SunSplit split = find_suns(e, {.order = 3, .count = 2});
                for (std::size_t i = 0; i < split.suns.size(); ++i)
                    for (const double number :
                         {static_cast<double>(glm::length(split.suns[i].irradiance)),
                          split.suns[i].half_angle, split.energy_shares[i], split.error_with})
                        EXPECT_TRUE(std::isfinite(number)) << x << " on " << y;
                for (const glm::vec3& pixel : split.remainder.image.pixels)
                    EXPECT_TRUE(pixel.r >= 0 && pixel.g >= 0 && pixel.b >= 0) << x << " on " << y;
            } catch (const Error&) { // refused
            }
        }
}

} // namespace
} // namespace prt
