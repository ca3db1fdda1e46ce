// Tests least-squares fits of instance factors: they are recovered if the light has factors, for any subset
// of samples; otherwise samples count by their areas.

#include "bake/products/instances/instance_fit.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace instance_fits {

constexpr int kOrder = 4;
constexpr std::size_t kSamples = 96;
const glm::dvec3 kUp(0, 1, 0);

struct Draw {
    std::mt19937 random{11};
    std::normal_distribution<float> normal;

    float number() { return normal(random); }
    InstanceFactors factors(float spread) {
        std::array<float, kInstanceNumbers> numbers = numbers_of(open_factors());
        for (float& value : numbers)
            value += spread * number();
        return factors_of(numbers);
    }
};

/// A mesh of random transfer; all of its receivers are samples.
class InstanceFits : public testing::Test {
protected:
    InstanceFits() {
        for (float& value : mesh.vectors)
            value = draw.number();
        for (std::uint32_t s = 0; s < kSamples; ++s) {
            samples.receivers.push_back(s);
            samples.positions.push_back(
                glm::vec3{std::tanh(draw.number()), std::tanh(draw.number()), std::tanh(draw.number())});
            samples.areas.push_back(1);
        }
        shared.emplace(mesh, kUp);
    }
    /// Returns the light of the samples for modes with `factors`.
    std::vector<float> light_of(const InstanceFactors& factors) const {
        std::vector<float> light(mesh.vectors.size());
        for (std::size_t s = 0; s < kSamples; ++s)
            shared->sum(s, mode_factors(factors, samples.positions[s]),
                        std::span(light).subspan(s * mesh.dimension(), mesh.dimension()));
        return light;
    }
    /// The largest difference of two factors.
    static float difference(const InstanceFactors& a, const InstanceFactors& b) {
        const auto left = numbers_of(a), right = numbers_of(b);
        float most = 0;
        for (std::size_t i = 0; i < left.size(); ++i)
            most = std::max(most, std::abs(left[i] - right[i]));
        return most;
    }

    Draw draw;
    Transfer mesh = zero_transfer({kOrder, {{TermKind::direct, 1}, {TermKind::indirect, 3}}}, kSamples);
    InstanceSamples samples;
    std::optional<SharedTransfer> shared;
    std::vector<bool> all = std::vector<bool>(kSamples, false);
    std::vector<float> none = std::vector<float>(kSamples * mesh.dimension());
};

// The ridge is a ten-thousandth of the mean weight of samples on a number. It pulls the least determined
// numbers, the high bands at the rim of the box, towards unoccluded factors: by at most a sixth of their
// spread.
constexpr float kSpread = 0.3f, kRidged = kSpread / 6;

TEST_F(InstanceFits, FindTheFactorsOfTheLight) {
    const InstanceFactors wanted = draw.factors(kSpread);
    const std::vector<float> light = light_of(wanted);
    const InstanceFit fit(*shared, samples, kUp);
    const InstanceFactors found = fit.fit({light, all});
    EXPECT_LT(difference(found, wanted), kRidged);
    EXPECT_LT(fit.error(*shared, {light, all}, {none, 0}, found), 1e-3);
    EXPECT_LT(fit.error(*shared, {light, all}, {none, 0}, wanted), 1e-5);
    EXPECT_GT(fit.error(*shared, {light, all}, {none, 0}, open_factors()), 0.1);
}

TEST_F(InstanceFits, IgnoreOmittedSamples) {
    const InstanceFactors wanted = draw.factors(kSpread);
    std::vector<float> light = light_of(wanted);
    for (std::size_t s = 5; s < kSamples; s += 7) {
        all[s] = true;
        for (std::size_t i = 0; i < mesh.dimension(); ++i)
            light[s * mesh.dimension() + i] = 100 * draw.number();
    }
    const InstanceFit fit(*shared, samples, kUp);
    const InstanceFactors found = fit.fit({light, all});
    EXPECT_LT(difference(found, wanted), kRidged);
    EXPECT_LT(fit.error(*shared, {light, all}, {none, 0}, found), 1e-3);
}

TEST_F(InstanceFits, ASampleOfTwiceTheAreaIsTwoSamples) {
    InstanceSamples twice = samples;
    Transfer longer = mesh;
    std::vector<float> light = light_of(draw.factors(kSpread));
    for (float& value : light)
        value += draw.number(); // no factors fit it
    std::vector<float> longer_light = light;
    for (std::size_t s = 0; s < kSamples; s += 3) {
        samples.areas[s] = 2;
        twice.receivers.push_back(static_cast<std::uint32_t>(longer.receivers()));
        twice.positions.push_back(samples.positions[s]);
        twice.areas.push_back(1);
        const auto copy = [&](std::vector<float>& to) {
            const std::vector<float> term(to.begin() + static_cast<std::ptrdiff_t>(s * mesh.dimension()),
                                          to.begin() +
                                              static_cast<std::ptrdiff_t>((s + 1) * mesh.dimension()));
            to.insert(to.end(), term.begin(), term.end());
        };
        copy(longer.vectors);
        copy(longer_light);
    }
    const SharedTransfer longer_shared(longer, kUp);
    const InstanceFit weighed(*shared, samples, kUp), listed(longer_shared, twice, kUp);
    const std::vector<bool> longer_all(twice.receivers.size(), false);
    const InstanceFactors by_area = weighed.fit({light, all}),
                          by_number = listed.fit({longer_light, longer_all});
    EXPECT_LT(difference(by_area, by_number), 1e-3f);
    EXPECT_NEAR(weighed.error(*shared, {light, all}, {none, 0}, by_area),
                listed.error(longer_shared, {longer_light, longer_all},
                             {std::vector<float>(longer_light.size()), 0}, by_area),
                1e-4);
}

TEST_F(InstanceFits, SubtractRayNoiseFromErrors) {
    const InstanceFactors wanted = draw.factors(kSpread);
    const std::vector<float> exact = light_of(wanted);
    constexpr std::size_t kFirst = 3; // first sample that is traced twice
    constexpr int kTries = 60;
    double with = 0, without = 0;
    for (int t = 0; t < kTries; ++t) {
        std::vector<float> light = exact, differences;
        for (std::size_t s = 0; s < kSamples; ++s)
            for (std::size_t i = 0; i < mesh.dimension(); ++i) {
                const float a = draw.number(), again = draw.number();
                light[s * mesh.dimension() + i] += a;
                if (s % kSamplesToOfNoise == kFirst)
                    differences.push_back((a - again) / std::sqrt(2.0f));
            }
        const InstanceFit fit(*shared, samples, kUp);
        with += std::pow(fit.error(*shared, {light, all}, {differences, kFirst}, wanted), 2) / kTries;
        without += std::pow(fit.error(*shared, {light, all}, {none, kFirst}, wanted), 2) / kTries;
    }
    EXPECT_GT(without, 0.01);
    // Squares below zero count as zero: half of the spread of the noise of one try is left.
    EXPECT_LT(with, 0.15 * without);
}

/// The error of the factors under one light equals the error of its coefficients applied to the difference.
TEST_F(InstanceFits, ReportTheErrorUnderTheWorstLight) {
    const InstanceFactors wanted = draw.factors(kSpread), other = draw.factors(kSpread);
    const std::vector<float> light = light_of(wanted), modelled = light_of(other);
    const InstanceFit fit(*shared, samples, kUp);
    const double soft = fit.error(*shared, {light, all}, {none, 0}, other);
    double largest = soft;
    std::vector<Lighting> skies;
    for (int k = 0; k < 100; ++k) {
        Lighting sky{constant_light(kOrder, glm::vec3(0))};
        for (glm::vec3& coefficient : sky.sky.coefficients)
            coefficient = glm::vec3(draw.number());
        double wrong = 0, right = 0;
        const std::size_t count = sky.sky.coefficients.size(); // per channel: direct, then red, green, blue
        for (std::size_t s = 0; s < kSamples; ++s)
            for (std::size_t color = 0; color < 3; ++color) {
                double off = 0, sum = 0;
                for (const std::size_t channel : {std::size_t{0}, 1 + color})
                    for (std::size_t i = 0; i < count; ++i) {
                        const std::size_t at = s * mesh.dimension() + channel * count + i;
                        const auto coefficient = static_cast<double>(sky.sky.coefficients[i].x);
                        off += coefficient * static_cast<double>(light[at] - modelled[at]);
                        sum += coefficient * static_cast<double>(light[at]);
                    }
                wrong += off * off;
                right += sum * sum;
            }
        largest = std::max(largest, std::sqrt(wrong / right));
        skies.push_back(std::move(sky));
    }
    EXPECT_GT(largest, 1.01 * soft); // otherwise the lights have no effect
    EXPECT_NEAR(fit.error(*shared, {light, all}, {none, 0}, other, skies), largest, 1e-3 * largest);
}

} // namespace instance_fits
} // namespace prt
