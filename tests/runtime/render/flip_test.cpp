// FLIP against closed forms and a filter written a second time, without separable kernels.

#include "runtime/render/picture_error.h"

#include "prt/core/error.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace prt {
namespace {

using std::numbers::pi;

Image constant(int width, int height, const glm::vec3& color) {
    return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), color)};
}

Image noise(int width, int height, const glm::vec3& mean, float amplitude, unsigned seed) {
    Image image = constant(width, height, mean);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-amplitude, amplitude);
    for (glm::vec3& pixel : image.pixels)
        pixel += value(random);
    return image;
}

double mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Lightness of CIELab of a grey.
double lightness(double grey) {
    const double delta = 6.0 / 29;
    return 116 * (grey > delta * delta * delta ? std::cbrt(grey) : grey / (3 * delta * delta) + 4.0 / 29) -
           16;
}

/// Distance of green and blue as the papers measure it, from CIELab in closed form.
double green_to_blue() {
    const auto lab = [](const glm::dvec3& xyz) {
        const double x = std::cbrt(xyz.x / 0.95042855), y = std::cbrt(xyz.y),
                     z = std::cbrt(xyz.z / 1.08890037);
        const double l = 116 * y - 16;
        return glm::dvec3(l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z));
    };
    const glm::dvec3 d = lab({0.35759149, 0.71518298, 0.11919716}) - lab({0.18045049, 0.0721802, 0.95037259});
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

TEST(Flip, IsZeroForEqualPictures) {
    const Image image = noise(20, 12, glm::vec3(0.4f), 0.3f, 1);
    for (const float value : flip(image, image))
        EXPECT_EQ(value, 0);
    for (const float value : hdr_flip(image, image))
        EXPECT_EQ(value, 0);
}

TEST(Flip, PlainGreysFollowLightness) {
    const double most = std::pow(green_to_blue(), 0.7);
    for (const auto& [a, b] : {std::pair(0.2, 0.21), std::pair(0.5, 0.3), std::pair(0.0, 1.0)}) {
        const double error = std::pow(std::abs(lightness(a) - lightness(b)), 0.7);
        const double expected = error < 0.4 * most ? 0.95 / 0.4 * error / most
                                                   : 0.95 + 0.05 * (error - 0.4 * most) / (0.6 * most);
        const auto values = flip(constant(9, 5, glm::vec3(static_cast<float>(a))),
                                 constant(9, 5, glm::vec3(static_cast<float>(b))));
        for (const float value : values) // the kernels add up to 1 in floats
            EXPECT_NEAR(value, expected, 2e-4) << a << " and " << b;
    }
}

TEST(Flip, GreenAndBlueDifferByOne) {
    for (const float value : flip(constant(7, 7, {0, 1, 0}), constant(7, 7, {0, 0, 1})))
        EXPECT_NEAR(value, 1, 1e-4);
}

TEST(Flip, FineNoiseIsLessVisibleFromFarther) {
    const Image plain = constant(96, 96, glm::vec3(0.5f)), noisy = noise(96, 96, glm::vec3(0.5f), 0.1f, 2);
    double before = 1;
    for (const float pixels_per_degree : {15.0f, 30.0f, 67.0f, 140.0f}) {
        const double now = mean(flip(plain, noisy, {.pixels_per_degree = pixels_per_degree, .threads = 1}));
        EXPECT_LT(now, before) << pixels_per_degree;
        before = now;
    }
}

/// Value of a filter with weights (x, y) at the middle of a picture, by a sum over the plane.
template <class Weight>
double filtered_at_middle(const std::vector<double>& plane, int size, int radius, Weight weight) {
    double sum = 0, positive = 0, negative = 0;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x)
            (weight(x, y) > 0 ? positive : negative) += std::abs(weight(x, y));
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) {
            const double w = weight(x, y);
            sum += w / (w > 0 ? positive : negative) *
                   plane[static_cast<std::size_t>((size / 2 + y) * size + size / 2 + x)];
        }
    return sum;
}

TEST(Flip, GreysMatchIntegralsOverThePlane) {
    constexpr int kSize = 41;
    const double pixels_per_degree = 67;
    Image a = noise(kSize, kSize, glm::vec3(0.4f), 0.2f, 3), b = a;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            b.at(x, y) =
                glm::min(b.at(x, y) + (x > 19 ? 0.1f : 0.0f) + (y == 20 && x == 21 ? 0.3f : 0.0f), 1.0f);
    const double deviation = 0.5 * 0.082 * pixels_per_degree;
    const auto gauss = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2 * deviation * deviation)); };
    const auto seen = [&](const Image& image) {
        std::vector<double> grey;
        for (const glm::vec3& pixel : image.pixels)
            grey.push_back(static_cast<double>(pixel.g));
        const auto at_middle = [&](int radius, auto weight) {
            return filtered_at_middle(grey, kSize, radius, weight);
        };
        const int radius = static_cast<int>(std::ceil(3 * deviation));
        const double edge = std::hypot(at_middle(radius, [&](int x, int y) { return -x * gauss(x, y); }),
                                       at_middle(radius, [&](int x, int y) { return -y * gauss(x, y); }));
        const auto second = [&](int along, int x, int y) {
            return (along * along / (deviation * deviation) - 1) * gauss(x, y);
        };
        const double point = std::hypot(at_middle(radius, [&](int x, int y) { return second(x, x, y); }),
                                        at_middle(radius, [&](int x, int y) { return second(y, x, y); }));
        const double smooth = at_middle(10, [&](int x, int y) {
            return std::exp(-pi * pi * (x * x + y * y) / (pixels_per_degree * pixels_per_degree) / 0.0047);
        });
        return std::array{lightness(smooth), edge, point};
    };
    const auto first = seen(a), second = seen(b);
    const double color = 0.95 / 0.4 * std::pow(std::abs(first[0] - second[0]) / green_to_blue(), 0.7);
    const double feature =
        std::max(std::abs(first[1] - second[1]), std::abs(first[2] - second[2])) / std::numbers::sqrt2;
    const double expected = std::pow(color, 1 - std::sqrt(feature));
    const auto values = flip(a, b);
    EXPECT_NEAR(values[kSize / 2 * kSize + kSize / 2], expected, 1e-3 * expected);
    EXPECT_GT(feature, 0.01);
}

TEST(HdrFlip, LooksFromTheBrightestPixelToTheMedian) {
    Image image = constant(5, 1, glm::vec3(1));
    image.pixels[0] = glm::vec3(64);
    const FlipExposures exposures = flip_exposures(image);
    EXPECT_NEAR(exposures.stop - exposures.start, 6, 1e-9);
    EXPECT_EQ(exposures.count, 6);
    const double x = std::exp2(exposures.stop) * 0.6; // the median
    EXPECT_NEAR(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.85, 1e-9);
}

TEST(HdrFlip, SeesErrorsInTheDarkAndInTheLight) {
    Image image = constant(40, 20, glm::vec3(0.01f));
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 10; ++x)
            image.at(x, y) = glm::vec3(100);
    Image dark = image, light = image;
    dark.at(30, 10) = glm::vec3(0.05f);
    light.at(3, 10) = glm::vec3(10);
    EXPECT_GT(hdr_flip(image, dark)[10 * 40 + 30], 0.2f);
    EXPECT_GT(hdr_flip(image, light)[10 * 40 + 3], 0.1f);
    // Scaling both pictures has no effect.
    Image twice = image, dark_twice = dark;
    for (Image* scaled : {&twice, &dark_twice})
        for (glm::vec3& pixel : scaled->pixels)
            pixel *= 1024;
    EXPECT_NEAR(mean(hdr_flip(twice, dark_twice)), mean(hdr_flip(image, dark)), 1e-5);
}

TEST(HdrFlip, EndsForBlackAndNegativePictures) {
    const Image black = constant(8, 8, glm::vec3(0));
    EXPECT_EQ(mean(hdr_flip(black, constant(8, 8, glm::vec3(-1)))), 0);
    EXPECT_GT(mean(hdr_flip(black, constant(8, 8, glm::vec3(1)))), 0.9);
    Image spark = black;
    spark.pixels[3] = glm::vec3(1);
    EXPECT_LE(flip_exposures(spark).count, 20);
}

TEST(HdrFlip, RejectsDifferentSizesAndNonFiniteValues) {
    const Image image = constant(4, 4, glm::vec3(1));
    EXPECT_THROW(hdr_flip(image, constant(4, 3, glm::vec3(1))), Error);
    EXPECT_THROW(hdr_flip(Image{}, Image{}), Error);
    EXPECT_THROW(hdr_flip(image, constant(4, 4, glm::vec3(std::nanf("")))), Error);
}

TEST(PictureError, DoesNotCountTheNoiseOfTheReference) {
    constexpr std::size_t kPixels = 200000;
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, 0.3f);
    Image picture{static_cast<int>(kPixels), 1, {}}, a = picture, b = picture;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const glm::vec3 truth(1, 2, 0.5f);
        picture.pixels.push_back(1.05f * truth);
        a.pixels.push_back(truth + glm::vec3(noise(random), noise(random), noise(random)));
        b.pixels.push_back(truth + glm::vec3(noise(random), noise(random), noise(random)));
    }
    const std::vector<bool> all(kPixels, true);
    // The noise alone would be 0.3 sqrt(3) / |truth| = 23 %. Its product has a standard error of 1.4e-4
    // in 2.5e-3.
    EXPECT_NEAR(relative_l2(picture, {a, b}, all), 0.05, 0.004);
    EXPECT_GT(relative_l2(picture, {a, a}, all), 0.2); // one reference alone counts its noise
    std::vector<bool> none(kPixels, false);
    none[7] = true;
    picture.pixels[7] = a.pixels[7] = b.pixels[7] = glm::vec3(1);
    EXPECT_EQ(relative_l2(picture, {a, b}, none), 0);
}

} // namespace
} // namespace prt
