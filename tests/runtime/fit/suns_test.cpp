// Suns painted into skies, found again.

#include "prt/fit/suns.h"

#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "support/painted_sky.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;
using test::painted_sky;
using test::PaintedDisc;
using test::Radiance;

constexpr double kDegree = pi / 180;

glm::dvec3 unit(double x, double y, double z) {
    return glm::normalize(glm::dvec3(x, y, z));
}

const Sun& nearest(const SunSplit& split, const glm::dvec3& towards) {
    return *std::ranges::min_element(
        split.suns, {}, [&](const Sun& sun) { return glm::distance(glm::dvec3(sun.towards), towards); });
}

/// Requirements on every search: 0.1 degrees, 2 % of each channel, 20 % of the size.
void expect_found(const SunSplit& split, const PaintedDisc& disc) {
    ASSERT_FALSE(split.suns.empty());
    const Sun& sun = nearest(split, disc.towards);
    EXPECT_LT(glm::distance(glm::dvec3(sun.towards), disc.towards), 0.1 * kDegree);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(sun.irradiance[c]), disc.irradiance()[c],
                    0.02 * disc.irradiance()[c]);
    EXPECT_NEAR(sun.half_angle, disc.half_angle, 0.2 * disc.half_angle);
}

/// A sun that is about half of the light, and an image with 3 to 7 texels across it.
struct SunSize {
    double degrees;
    int width;
    double radiance;
};

PaintedDisc disc_of(const SunSize& size, const glm::dvec3& towards) {
    return {towards, 0.5 * size.degrees * kDegree, size.radiance * glm::dvec3(1, 0.8, 0.5)};
}

constexpr SunSize kSizes[] = {{5, 256, 60}, {2, 512, 400}, {1, 1024, 1600}};

class Suns : public testing::TestWithParam<Radiance> {};
INSTANTIATE_TEST_SUITE_P(Skies, Suns, testing::Values(test::gradient_sky, test::cloudy_sky));

TEST_P(Suns, AreFoundAtEveryPosition) {
    // In the open, at the seam and the poles of a lat-long image, at an edge and a corner of a cube's.
    for (const glm::dvec3& towards : {unit(0.4, 0.5, 0.7), unit(0.001, 0.3, -1), unit(0.002, 1, 0.001),
                                      unit(0, -1, 0), unit(1, 0.2, 1), unit(-1, 1, 1)})
        for (const SunSize& size : {kSizes[0], kSizes[1]})
            for (const EnvironmentLayout layout :
                 {EnvironmentLayout::lat_long, EnvironmentLayout::cube, EnvironmentLayout::cube_faces}) {
                const bool flat = layout == EnvironmentLayout::lat_long;
                const PaintedDisc disc = disc_of(size, towards);
                const Environment e = painted_sky(layout, flat ? size.width : size.width / 4, size.width / 2,
                                                  GetParam(), {disc});
                SCOPED_TRACE(testing::Message()
                             << size.degrees << " degrees, layout " << static_cast<int>(layout) << ", "
                             << towards.x << " " << towards.y << " " << towards.z);
                expect_found(find_suns(e, {.count = 1}), disc);
            }
}

TEST_P(Suns, AreFoundDownToAQuarterOfADegree) {
    for (const SunSize& size : {kSizes[2], SunSize{0.25, 2880, 25000}}) {
        SCOPED_TRACE(size.degrees);
        const PaintedDisc disc = disc_of(size, unit(-0.6, 0.4, 0.5));
        expect_found(find_suns(painted_sky(EnvironmentLayout::lat_long, size.width, size.width / 2,
                                           GetParam(), {disc}),
                               {.count = 1}),
                     disc);
    }
}

TEST(Suns, KeepTheirPositionNearBrightClouds) {
    // The sky rises tenfold from one side of the disc to the other, to the disc's own brightness.
    const PaintedDisc disc = disc_of(kSizes[0], unit(0.4, 0.5, 0.7));
    const glm::dvec3 aside = glm::normalize(glm::cross(disc.towards, glm::dvec3(0.3, 1, 0)));
    for (const glm::dvec3& up : {aside, glm::cross(disc.towards, aside)}) {
        const auto slope = [&](const glm::dvec3& w) {
            return glm::dvec3(std::clamp(22 + 280 * glm::dot(w, up), 4.0, 40.0));
        };
        const SunSplit split =
            find_suns(painted_sky(EnvironmentLayout::lat_long, 512, 256, slope, {disc}), {.count = 1});
        ASSERT_EQ(split.suns.size(), 1u);
        EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), disc.towards), 0.1 * kDegree);
        EXPECT_NEAR(split.suns[0].half_angle, disc.half_angle, 0.2 * disc.half_angle);
    }
}

TEST(Suns, NearEachOtherKeepTheirColors) {
    // Three degrees from each other, with diameters of one degree and of 1.5.
    const std::vector<PaintedDisc> discs = {{unit(0.3, 0.4, 0.8), 0.5 * kDegree, {900, 300, 100}},
                                            {unit(0.3, 0.46, 0.8), 0.75 * kDegree, {100, 200, 500}}};
    const SunSplit split = find_suns(
        painted_sky(EnvironmentLayout::lat_long, 1024, 512, test::gradient_sky, discs), {.count = 2});
    ASSERT_EQ(split.suns.size(), 2u);
    for (const PaintedDisc& disc : discs)
        expect_found(split, disc);
}

TEST(Suns, AreTheFourLampsOfANight) {
    std::vector<PaintedDisc> lamps;
    for (const glm::dvec3& towards :
         {unit(1, 0.5, 0), unit(-1, 0.6, 0.3), unit(0, 0.4, 1), unit(0.2, 0.5, -1)})
        lamps.push_back({towards, 1.5 * kDegree, {60, 40, 15}});
    const Radiance night = [](const glm::dvec3& w) { return glm::dvec3(0.002, 0.003, 0.006) * (1.5 + w.y); };
    const SunSplit split = find_suns(painted_sky(EnvironmentLayout::lat_long, 512, 256, night, lamps));
    ASSERT_EQ(split.suns.size(), 4u);
    for (const PaintedDisc& lamp : lamps)
        expect_found(split, lamp);
    EXPECT_LT(split.error_with, 0.1 * split.error_without);
}

/// A plateau of equal values is a disc like any other.
TEST(Suns, MayBeClipped) {
    const PaintedDisc disc{unit(0.5, 0.6, -0.4), 2 * kDegree, glm::dvec3(1000)};
    Environment e =
        painted_sky(EnvironmentLayout::lat_long, 512, 256,
                    [](const glm::dvec3& w) { return glm::dvec3(0.1, 0.15, 0.2) * (1.2 + w.y); }, {disc});
    for (glm::vec3& pixel : e.image.pixels)
        pixel = glm::min(pixel, glm::vec3(1));
    const SunSplit split = find_suns(e, {.count = 1});
    ASSERT_EQ(split.suns.size(), 1u);
    EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), disc.towards), 0.1 * kDegree);
    EXPECT_NEAR(split.suns[0].half_angle, disc.half_angle, 0.2 * disc.half_angle);
}

/// Light that a lens spreads around a sun is not part of its disc.
TEST(Suns, KeepTheirSizeInAHalo) {
    const PaintedDisc disc{unit(0.5, 0.6, -0.4), 0.75 * kDegree, glm::dvec3(5000)};
    const Radiance sky = [&](const glm::dvec3& w) {
        return glm::dvec3(0.3) + 20.0 * std::exp(-glm::distance(w, disc.towards) / (2 * kDegree));
    };
    const SunSplit split =
        find_suns(painted_sky(EnvironmentLayout::lat_long, 512, 256, sky, {disc}), {.count = 1});
    ASSERT_EQ(split.suns.size(), 1u);
    EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), disc.towards), 0.1 * kDegree);
    EXPECT_NEAR(split.suns[0].half_angle, disc.half_angle, 0.2 * disc.half_angle);
}

TEST(Suns, HaveAtMostTexelSizeForOneTexel) {
    for (const auto& [x, y] : {std::pair(20, 9), std::pair(0, 16), std::pair(63, 0), std::pair(5, 31)}) {
        Environment e;
        e.image = {64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.5f, 0.6f, 0.8f))};
        e.image.at(x, y) = glm::vec3(1e5f);
        const SunSplit split = find_suns(e);
        ASSERT_EQ(split.suns.size(), 1u) << x << " " << y;
        const double texel = pi / 32;
        const glm::dvec3 middle = lat_long_direction(64, 32, x + 0.5, y + 0.5);
        EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), middle), 0.01 * texel);
        EXPECT_LE(split.suns[0].half_angle, 0.6 * texel);
        EXPECT_GT(split.energy_shares[0], 0.8); // a texel at a pole is small
    }
}

/// Compares band 0 by channel; in the other bands a disc replaces the removed pixels.
TEST(Suns, SumWithTheRemainderToTheImage) {
    for (const EnvironmentLayout layout : {EnvironmentLayout::lat_long, EnvironmentLayout::cube,
                                           EnvironmentLayout::cube_faces, EnvironmentLayout::angular}) {
        const Environment e = painted_sky(
            layout, 128, 64, test::cloudy_sky,
            {{unit(1, 0.7, 0.2), 3 * kDegree, {80, 60, 20}}, {unit(0, -0.2, 1), 2 * kDegree, {20, 60, 90}}});
        const SunSplit split = find_suns(e, {.order = 5, .count = 2});
        ASSERT_EQ(split.suns.size(), 2u);
        const Light whole = project(e, 5);
        Light back = project(split.remainder, 5);
        double share = split.remainder_share;
        for (const Sun& sun : split.suns)
            back = sum(back, as_light(sun, 5));
        for (const double of_sun : split.energy_shares)
            share += of_sun;
        EXPECT_NEAR(share, 1, 1e-12);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(back.coefficients[0][c] / whole.coefficients[0][c], 1, 1e-5);
            for (std::size_t i = 1; i < 25; ++i)
                EXPECT_NEAR(back.coefficients[i][c], whole.coefficients[i][c],
                            0.01 * whole.coefficients[0][c]);
        }
        for (std::size_t i = 0; i < e.image.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(split.remainder.image.pixels[i][c], 0.0f);
                EXPECT_LE(split.remainder.image.pixels[i][c], e.image.pixels[i][c] * (1 + 1e-6f));
            }
    }
}

TEST(Suns, AreCones) {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
    for (const double angle : {0.35, 0.1, 0.01}) {
        const double irradiance = pi * std::sin(angle) * std::sin(angle);
        const Light cone = cone_light(kMaxOrder, axis, angle, glm::vec3(1));
        const Light light = as_light({axis, glm::vec3(static_cast<float>(irradiance)), angle}, kMaxOrder);
        for (std::size_t i = 0; i < 100; ++i)
            EXPECT_NEAR(light.coefficients[i].r, cone.coefficients[i].r, 1e-5 * irradiance);
    }
}

TEST(Suns, DoNotDependOnThreads) {
    const Environment e = painted_sky(EnvironmentLayout::lat_long, 256, 128, test::cloudy_sky,
                                      {{unit(1, 0.7, 0.2), 3 * kDegree, {80, 60, 20}}});
    const SunSplit one = find_suns(e, {.count = 1, .threads = 1}),
                   many = find_suns(e, {.count = 1, .threads = 7});
    EXPECT_EQ(one.suns[0].towards, many.suns[0].towards);
    EXPECT_EQ(one.suns[0].irradiance, many.suns[0].irradiance);
    EXPECT_EQ(one.error_with, many.error_with);
}

} // namespace
} // namespace prt
