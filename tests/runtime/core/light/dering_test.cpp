// Tests the filter against negative light.

#include "prt/core/dering.h"

#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Returns the minimum radiance of any channel over `directions`, relative to the channel's mean, in double.
double min_share(const Light& light, const std::vector<glm::dvec3>& directions) {
    double least = 1e30;
    std::array<double, kMaxOrder * kMaxOrder> basis{};
    for (const glm::dvec3& w : directions) {
        evaluate_sh(light.order, w, std::span<double>(basis));
        glm::dvec3 value(0);
        for (std::size_t i = 0; i < light.coefficients.size(); ++i)
            value += basis[i] * glm::dvec3(light.coefficients[i]);
        value /= basis[0] * glm::dvec3(light.coefficients[0]);
        least = std::min({least, value.x, value.y, value.z});
    }
    return least;
}

/// Returns a spherical Fibonacci lattice; its points are independent of the cells of the filter.
std::vector<glm::dvec3> lattice(int count) {
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
        const double angle = 2 * std::numbers::pi * 0.61803398874989485 * i;
        directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return directions;
}

Light sunny(int order, const glm::vec3& towards, const glm::vec3& sky) {
    return sum(sum(directional_light(order, towards, {3, 2.5f, 2}),
                   directional_light(order, glm::normalize(glm::vec3(-1, 0.2f, 0.4f)), {0.5f, 1, 2})),
               constant_light(order, sky));
}

const glm::vec3 kTowards = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));

TEST(Dering, NoDirectionHasNegativeRadianceAtAnyOrder) {
    const std::vector<glm::dvec3> directions = lattice(40000); // half a degree
    for (int order = 1; order <= kMaxOrder; ++order)
        for (const float sky : {0.0f, 0.02f, 0.3f}) {
            const Light light = sunny(order, kTowards, glm::vec3(sky, sky, 2 * sky));
            const Light quiet = deringed(light);
            EXPECT_GE(min_share(quiet, directions), -1e-6) << "order " << order << ", sky " << sky;
            EXPECT_EQ(quiet.coefficients[0], light.coefficients[0]); // energy stays
        }
}

/// For any occlusion: of all receivers with one normal, the darkest sees only the negative light.
TEST(Dering, NoShadowedReceiverHasNegativeExitRadiance) {
    const Light raw = sunny(6, kTowards, {0.1f, 0.1f, 0.2f}), quiet = deringed(raw);
    double darkest_raw = 0, darkest_quiet = 0;
    for (const glm::dvec3& normal : lattice(20)) {
        double before = 0, after = 0;
        for (const auto& [w, weight] : test::sphere_quadrature(120)) {
            const double cosine = std::max(glm::dot(normal, w), 0.0) / std::numbers::pi * weight;
            before += cosine * std::min(0.0f, radiance(raw, glm::vec3(w)).r);
            after += cosine * std::min(0.0f, radiance(quiet, glm::vec3(w)).r);
        }
        darkest_raw = std::min(darkest_raw, before);
        darkest_quiet = std::min(darkest_quiet, after);
    }
    EXPECT_LT(darkest_raw, -0.05);
    EXPECT_GE(darkest_quiet, -1e-6);
}

TEST(Dering, NonnegativeLightIsUnchanged) {
    const Light sky = sum(overcast_sky(6, {1, 1, 2}), constant_light(6, glm::vec3(0.2f)));
    EXPECT_EQ(deringed(sky).coefficients, sky.coefficients);
    EXPECT_EQ(deringed(constant_light(3, {0, 1, 0})).coefficients, constant_light(3, {0, 1, 0}).coefficients);
    EXPECT_EQ(deringed(constant_light(3, {0, 0, 0})).coefficients, constant_light(3, {0, 0, 0}).coefficients);
}

/// For a white sun of order 3 the filter is known: 1 + 3 a t + 5 b (3 t² - 1) / 2 >= 0 on [-1, 1], with
/// minimum (1 - a)² 3 + (1 - b)² 5/4 (the powers of bands 1 and 2 have a ratio of 3 to 5, over l²). The
/// minimum is inside the interval, at t = -a / (5 b), where 1 - 5 b / 2 - 3 a² / (10 b) = 0.
TEST(Dering, FactorsOfASunMatchTheClosedForm) {
    double best_a = 0, best_b = 0, best = 1e9;
    for (int i = 1; i < 400000; ++i) {
        const double b = 0.4 * i / 400000, a = std::sqrt(10 * b * (1 - 2.5 * b) / 3);
        if (a > 5 * b) // the minimum is at t = -1
            continue;
        if (const double change = 3 * (1 - a) * (1 - a) + 1.25 * (1 - b) * (1 - b); change < best) {
            best = change;
            best_a = a;
            best_b = b;
        }
    }
    const BandFactors factors = dering_factors(directional_light(3, kTowards, glm::vec3(1)));
    EXPECT_NEAR(factors[1], best_a, 0.02);
    EXPECT_NEAR(factors[2], best_b, 0.02);
    EXPECT_EQ(factors[0], 1);
}

/// Diffusion over the sphere, exp(-t l (l+1)), is the only window with a monotone effect, and was used
/// before.
TEST(Dering, KeepsMoreThanMinimumDiffusion) {
    const std::vector<glm::dvec3> directions = lattice(4000);
    for (const int order : {4, 6, 10}) {
        const Light sun = sunny(order, kTowards, {0.1f, 0.1f, 0.2f});
        const auto diffused = [&](double time) {
            BandFactors factors;
            for (std::size_t l = 0; l < factors.size(); ++l)
                factors[l] = std::exp(-time * static_cast<double>(l * (l + 1)));
            return factors;
        };
        double low = 0, high = 4;
        for (int step = 0; step < 20; ++step) {
            const double time = 0.5 * (low + high);
            (min_share(with_band_factors(sun, diffused(time)), directions) < 0 ? low : high) = time;
        }
        const BandFactors least = dering_factors(sun), diffusion = diffused(high);
        EXPECT_GT(least[1], diffusion[1]);
        EXPECT_GT(least[2], diffusion[2]);
        EXPECT_GT(least[static_cast<std::size_t>(order - 1)], diffusion[static_cast<std::size_t>(order - 1)]);
    }
}

TEST(Dering, ChannelsHaveEqualWeight) {
    const Light light = sunny(6, kTowards, {0.05f, 0.1f, 0.2f});
    Light swapped = light;
    for (glm::vec3& c : swapped.coefficients)
        c = {c.b, c.r, c.g};
    const BandFactors a = dering_factors(light), b = dering_factors(swapped);
    for (std::size_t l = 0; l < 6; ++l)
        EXPECT_NEAR(a[l], b[l], 1e-4) << l;
}

TEST(Dering, DoesNotDependOnRotation) {
    const Light light = sunny(6, kTowards, {0.05f, 0.1f, 0.2f});
    Light rotated = light;
    ShRotation(6, glm::angleAxis(1.1, glm::normalize(glm::dvec3(1, 2, 3)))).apply(rotated.coefficients);
    const BandFactors a = dering_factors(light), b = dering_factors(rotated);
    for (std::size_t l = 0; l < 6; ++l)
        EXPECT_NEAR(a[l], b[l], 0.02) << l;
}

/// The remainder of a sky without its sun may have a channel that is negative on the whole.
TEST(Dering, ChannelsWithoutPositiveMeanAreIgnored) {
    Light light = sunny(5, kTowards, {0.1f, 0.1f, 0.1f});
    for (glm::vec3& c : light.coefficients)
        c.b = -c.b;
    const Light quiet = deringed(light);
    for (const glm::dvec3& w : lattice(4000)) {
        const glm::vec3 value = radiance(quiet, glm::vec3(w));
        EXPECT_GE(std::min(value.r, value.g), -1e-5f);
    }
}

} // namespace
} // namespace prt
