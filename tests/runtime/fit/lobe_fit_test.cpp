// The fit of lobes to transfer vectors, and their bytes.

#include "prt/fit/lobe_fit.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "runtime/fit/sh_gradient.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace prt {
namespace lobe_fits { // joined sources share one scope
namespace {

constexpr std::size_t kCoefficients = 16;

struct Targets {
    std::vector<double> vectors;
    std::vector<float> areas;
    std::vector<glm::dvec3> normals;
    LobeTargets view() const { return {4, vectors, areas}; }
};

glm::dvec3 any_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(glm::dvec3(x, y, z));
}

Targets open_vertices(std::size_t count) {
    std::mt19937 random(1);
    Targets targets{std::vector<double>(count * kCoefficients), std::vector<float>(count, 1.0f), {}};
    for (std::size_t v = 0; v < count; ++v) {
        targets.normals.push_back(any_direction(random));
        clamped_cosine_lobe(4, targets.normals.back(),
                            std::span(targets.vectors).subspan(v * kCoefficients, kCoefficients));
    }
    return targets;
}

/// Returns the cosine lobe outside a blocked cap about a different axis, by quadrature: transfer like that of
/// bakes.
Targets shadowed_vertices(std::size_t count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    Targets targets{std::vector<double>(count * kCoefficients), {}, {}};
    for (std::size_t v = 0; v < count; ++v) {
        const glm::dvec3 normal = any_direction(random);
        const glm::dvec3 towards = glm::normalize(normal + 0.9 * any_direction(random));
        const double cap = std::cos(0.2 + unit(random));
        targets.normals.push_back(normal);
        targets.areas.push_back(static_cast<float>(0.5 + unit(random)));
        constexpr int kDirections = 1500;
        for (int i = 0; i < kDirections; ++i) { // a spherical Fibonacci lattice
            const double z = 1 - (2 * i + 1.0) / kDirections, radius = std::sqrt(1 - z * z);
            const double angle = 2 * M_PI * 0.61803398875 * i;
            const glm::dvec3 d(radius * std::cos(angle), radius * std::sin(angle), z);
            if (glm::dot(d, normal) <= 0 || glm::dot(d, towards) > cap)
                continue;
            std::array<double, kCoefficients> basis;
            evaluate_sh(4, d, basis);
            for (std::size_t j = 0; j < kCoefficients; ++j)
                targets.vectors[v * kCoefficients + j] += 4 * glm::dot(d, normal) * basis[j] / kDirections;
        }
    }
    return targets;
}

/// Largest difference of a coefficient.
double largest_error(const Targets& targets, std::span<const Lobe> lobes, std::size_t each) {
    double largest = 0;
    std::array<float, kCoefficients> found;
    for (std::size_t v = 0; v < targets.areas.size(); ++v) {
        lobe_transfer(lobes.subspan(v * each, each), 4, found);
        for (std::size_t i = 0; i < kCoefficients; ++i)
            largest = std::max(
                largest, std::abs(static_cast<double>(found[i]) - targets.vectors[v * kCoefficients + i]));
    }
    return largest;
}

TEST(LobeFit, GradientsMatchTheBasis) {
    std::mt19937 random(3);
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 d = any_direction(random),
                         along = glm::normalize(glm::cross(d, any_direction(random)));
        constexpr double kStep = 1e-5;
        std::array<double, kCoefficients> before, after;
        evaluate_sh(4, glm::normalize(d - kStep * along), before);
        evaluate_sh(4, glm::normalize(d + kStep * along), after);
        const auto gradients = sh_gradients(d);
        for (std::size_t j = 0; j < kCoefficients; ++j)
            EXPECT_NEAR(glm::dot(gradients[j], along), (after[j] - before[j]) / (2 * kStep), 1e-8) << j;
    }
}

TEST(LobeFit, LobesOfAnOpenVertexAreItsCosineLobe) {
    const Targets targets = open_vertices(200);
    for (const std::size_t lobes : {1u, 2u, 3u}) {
        const std::vector<Lobe> fitted = fit_lobes(targets.view(), {.lobes = lobes});
        EXPECT_LT(largest_error(targets, fitted, lobes), 1e-4) << lobes;
        for (std::size_t v = 0; v < targets.areas.size() && lobes == 1; ++v) {
            EXPECT_LT(glm::distance(glm::dvec3(fitted[v].axis), targets.normals[v]), 1e-4);
            for (int l = 0; l < 4; ++l)
                EXPECT_NEAR(fitted[v].profile[static_cast<std::size_t>(l)], clamped_cosine_factor(l), 1e-4);
        }
    }
}

TEST(LobeFit, QuantizedOpenVerticesDifferOnlyByTheirAxis) {
    const Targets targets = open_vertices(200);
    const LobeFitOptions options{.lobes = 1};
    const LobeModel model = code_lobes(targets.view(), fit_lobes(targets.view(), options), options);
    for (std::size_t v = 0; v < model.vertices(); ++v) {
        const Lobe lobe = model.decode(model.words[v]);
        EXPECT_GT(glm::dot(glm::dvec3(lobe.axis), targets.normals[v]), std::cos(0.95 * M_PI / 180));
        EXPECT_FLOAT_EQ(lobe.profile[0], 1);
        EXPECT_FLOAT_EQ(lobe.profile[1], 2.0f / 3);
    }
}

TEST(LobeFit, MoreLobesReduceTheError) {
    const Targets targets = shadowed_vertices(150);
    double before = 1;
    for (const std::size_t lobes : {1u, 2u, 3u}) {
        const LobeFitOptions options{.lobes = lobes};
        const double error = lobe_error(targets.view(), fit_lobes(targets.view(), options), options);
        RecordProperty("lobes_" + std::to_string(lobes), std::to_string(error));
        EXPECT_LT(error, 0.6 * before) << lobes;
        before = error;
    }
    EXPECT_LT(before, 0.02);
}

TEST(LobeFit, RotatesWithItsTarget) {
    const Targets targets = shadowed_vertices(40);
    const glm::dquat rotation = glm::angleAxis(2.1, glm::normalize(glm::dvec3(1, -2, 0.5)));
    Targets rotated = targets;
    for (std::size_t v = 0; v < targets.areas.size(); ++v) {
        const auto vector = std::span(rotated.vectors).subspan(v * kCoefficients, kCoefficients);
        ShRotation(4, rotation).apply(vector, vector);
    }
    const LobeFitOptions options{.lobes = 1};
    const std::vector<Lobe> still = fit_lobes(targets.view(), options),
                            moved = fit_lobes(rotated.view(), options);
    for (std::size_t v = 0; v < still.size(); ++v)
        EXPECT_LT(glm::distance(rotation * glm::dvec3(still[v].axis), glm::dvec3(moved[v].axis)), 2e-3) << v;
}

TEST(LobeFit, BytesCostLittleAndRespectTheFurnace) {
    const Targets targets = shadowed_vertices(300);
    for (const std::size_t lobes : {1u, 2u, 3u}) {
        const LobeFitOptions options{.lobes = lobes};
        const std::vector<Lobe> fitted = fit_lobes(targets.view(), options);
        const LobeModel model = code_lobes(targets.view(), fitted, options);
        check_lobes(model);
        const std::vector<Lobe> coded = decoded(model);
        EXPECT_LT(lobe_error(targets.view(), coded, options),
                  lobe_error(targets.view(), fitted, options) + 0.05)
            << lobes; // measured: 0.04
        for (std::size_t v = 0; v < model.vertices(); ++v) {
            float white = 0; // exit radiance under uniform radiance 1
            for (std::size_t k = 0; k < lobes; ++k)
                white += coded[v * lobes + k].profile[0];
            EXPECT_LE(white, 1 + 1e-5f);
        }
    }
}

TEST(LobeFit, DoesNotDependOnThreads) {
    const Targets targets = shadowed_vertices(300);
    LobeFitOptions options{.lobes = 2, .threads = 1};
    const LobeModel one = code_lobes(targets.view(), fit_lobes(targets.view(), options), options);
    options.threads = 3;
    const LobeModel three = code_lobes(targets.view(), fit_lobes(targets.view(), options), options);
    EXPECT_EQ(one.words, three.words);
    EXPECT_EQ(one.profiles, three.profiles);
}

TEST(LobeFit, AcceptsUnlitVertices) {
    Targets targets = shadowed_vertices(3);
    std::fill_n(targets.vectors.begin(), kCoefficients, 0.0);
    targets.areas[1] = 0;
    const LobeModel model = code_lobes(targets.view(), fit_lobes(targets.view(), {}), {});
    std::array<Lobe, kMaxLobes> lobes;
    model.decode(0, lobes);
    for (const Lobe& lobe : lobes)
        for (const float gain : lobe.profile)
            EXPECT_EQ(gain, 0);
    EXPECT_EQ(code_lobes({4, {}, {}}, {}, {}).vertices(), 0u);
}

TEST(LobeFit, RejectsInvalidInput) {
    Targets targets = shadowed_vertices(2);
    EXPECT_THROW(fit_lobes(targets.view(), {.lobes = 4}), Error);
    EXPECT_THROW(fit_lobes({3, targets.vectors, targets.areas}, {}), Error);
    targets.vectors[17] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(fit_lobes(targets.view(), {}), Error);
}

} // namespace
} // namespace lobe_fits
} // namespace prt
