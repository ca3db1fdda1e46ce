// Tests dipole diffusion and media.

#include "bake/transport/diffusion.h"
#include "prt/bake/bake.h"
#include "prt/bake/bake_options.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>

namespace prt {
namespace {

using std::numbers::pi;

TEST(Dipole, IntegratesToItsClosedForm) {
    for (const NamedMedium& named : measured_media())
        for (int c = 0; c < 3; ++c) {
            const Dipole dipole(named.medium.scattering[c], named.medium.absorption[c], named.medium.ior);
            const double unit =
                1 / (named.medium.scattering[c] + named.medium.absorption[c]); // a mean free path
            double sum = 0;
            constexpr int kSteps = 20000;
            for (int i = 0; i < kSteps; ++i) { // to 5 mean free paths, by the midpoint rule
                const double r = 5 * unit * (i + 0.5) / kSteps;
                sum += dipole.reflectance(r) * 2 * pi * r * 5 * unit / kSteps;
            }
            EXPECT_NEAR(sum, dipole.inside(5 * unit), 1e-6) << named.name;
            EXPECT_NEAR(dipole.total(), dipole.inside(std::numeric_limits<double>::infinity()), 1e-12);
            EXPECT_LE(dipole.total(), 1);
        }
    // Without absorption all light returns.
    EXPECT_NEAR(Dipole(1000, 0, 1.3).total(), 1, 1e-12);
}

// Jensen, Marschner, Levoy and Hanrahan 2001, figure 5: reduced scattering and absorption per millimetre.
TEST(MeasuredMedia, MatchThePaper) {
    struct Row {
        std::string_view name;
        glm::dvec3 scattering, absorption;
    };
    const Row rows[] = {{"apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}},
                        {"chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
                        {"chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}},
                        {"cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
                        {"ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},
                        {"marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
                        {"potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}},
                        {"skim-milk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
                        {"skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},
                        {"skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
                        {"spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}},
                        {"whole-milk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}}};
    ASSERT_EQ(measured_media().size(), std::size(rows));
    for (std::size_t i = 0; i < std::size(rows); ++i) {
        const auto& [name, medium] = measured_media()[i];
        EXPECT_EQ(name, rows[i].name);
        EXPECT_EQ(medium.ior, name == "marble" ? 1.5 : 1.3) << name;
        for (int c = 0; c < 3; ++c) { // in metres
            EXPECT_NEAR(medium.scattering[c], 1000 * rows[i].scattering[c], 1e-9) << name;
            EXPECT_NEAR(medium.absorption[c], 1000 * rows[i].absorption[c], 1e-9) << name;
        }
    }
}

TEST(Dipole, MarbleHasTheTabulatedReflectance) {
    // Jensen et al. 2001, figure 5: diffuse reflectance of marble 0.83, 0.79, 0.75; of skin1 0.44, 0.22,
    // 0.13.
    const auto reflectance = [](const char* name, int c) {
        for (const NamedMedium& named : measured_media())
            if (named.name == name)
                return Dipole(named.medium.scattering[c], named.medium.absorption[c], named.medium.ior)
                    .total();
        return 0.0;
    };
    EXPECT_NEAR(reflectance("marble", 0), 0.83, 0.04);
    EXPECT_NEAR(reflectance("marble", 1), 0.79, 0.04);
    EXPECT_NEAR(reflectance("marble", 2), 0.75, 0.04);
    EXPECT_NEAR(reflectance("skin1", 0), 0.44, 0.04);
    EXPECT_NEAR(reflectance("skin1", 1), 0.22, 0.04);
    EXPECT_NEAR(reflectance("skin1", 2), 0.13, 0.04);
}

TEST(ReducedAlbedo, YieldsTheRequestedReflectance) {
    for (const double reflectance : {0.05, 0.3, 0.6, 0.95}) {
        const double albedo = reduced_albedo(reflectance, 1.5);
        EXPECT_NEAR(Dipole(albedo * 700, (1 - albedo) * 700, 1.5).total(), reflectance, 1e-9);
    }
}

struct Plane {
    Receivers receivers;
    std::vector<glm::uvec3> triangles;
};

/// A square of side 2 in the plane y = 0, a grid of n x n cells with shaken points.
Plane plane(int n) {
    Plane result;
    Receivers& r = result.receivers;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> shake(-0.15f, 0.15f); // no more, lest triangles fold over
    const float cell = 2.0f / static_cast<float>(n);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const float x = static_cast<float>(i) + shake(random), z = static_cast<float>(j) + shake(random);
            r.positions.emplace_back(cell * x - 1, 0, cell * z - 1);
            r.normals.emplace_back(0, 1, 0);
            r.areas.push_back(cell * cell);
        }
    const auto at = [&](int i, int j) { return static_cast<unsigned>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            result.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            result.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    return result;
}

DiffusionOperator operator_on(const Plane& plane, const Medium& medium, double tolerance = 0.1) {
    return DiffusionOperator(plane.receivers, plane.triangles, medium, tolerance);
}

TEST(Diffusion, IsUniformOnAPlaneInUniformLight) {
    // Mean free paths far below, about and above the spacing of 1/32.
    const Plane square = plane(64);
    const Receivers& receivers = square.receivers;
    for (const double path : {0.001, 0.01, 0.03, 0.06}) {
        const Medium medium{glm::dvec3(0.9 / path), glm::dvec3(0.1 / path), 1.3};
        std::vector<float> values(receivers.size(), 2.0f);
        operator_on(square, medium).apply(1, 1, values, 0);
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (std::abs(receivers.positions[i].x) < 0.3f && std::abs(receivers.positions[i].z) < 0.3f) {
                sum += static_cast<double>(values[i]);
                ++count;
                EXPECT_NEAR(values[i], 2, 0.02) << path;
            }
        EXPECT_NEAR(sum / count, 2, 0.01) << path;
    }
}

TEST(Diffusion, IntegratesTheDipoleAtAShadowEdge) {
    const Plane square = plane(128);
    const Receivers& receivers = square.receivers;
    const double path = 0.03;
    const Medium medium{glm::dvec3(0.9 / path), glm::dvec3(0.1 / path), 1.3};
    const Dipole dipole(0.9 / path, 0.1 / path, 1.3);
    std::vector<float> values;
    for (const glm::vec3& p : receivers.positions)
        values.push_back(p.x > 0 ? 1.0f : 0.0f);
    operator_on(square, medium).apply(1, 1, values, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::vec3& p = receivers.positions[i];
        if (std::abs(p.z) > 0.2f || std::abs(p.x) > 0.2f)
            continue;
        // Light from the half plane at signed distance x: the fraction of the ring of radius r beyond the
        // edge.
        double expected = 0;
        constexpr int kSteps = 4000;
        constexpr double kFar = 0.8;
        const auto x = static_cast<double>(p.x);
        for (int s = 0; s < kSteps; ++s) {
            const double r = kFar * (s + 0.5) / kSteps;
            const double lit =
                r <= std::abs(x) ? (x > 0 ? 1 : 0) : 1 - std::acos(std::clamp(x / r, -1.0, 1.0)) / pi;
            expected += lit * dipole.reflectance(r) * 2 * pi * r * kFar / kSteps / dipole.total();
        }
        // On the mesh the edge is a ramp of 1/64 at a jittered position: this blurs and shifts a response
        // that rises by about 0.3 over the depth of 0.03, so by less than 0.08 at the edge, and by less
        // farther away.
        EXPECT_NEAR(static_cast<double>(values[i]), expected, std::abs(x) < 0.035 ? 0.08 : 0.04) << p.x;
    }
}

TEST(Diffusion, MatchesAFinerTolerance) {
    const Plane square = plane(40);
    const Receivers& receivers = square.receivers;
    const Medium medium{glm::dvec3(20), glm::dvec3(1), 1.3};
    std::vector<float> groups, pairs;
    for (const glm::vec3& p : receivers.positions)
        groups.push_back(1 + std::sin(9 * p.x) * p.z);
    pairs = groups;
    operator_on(square, medium).apply(1, 1, groups, 0);
    operator_on(square, medium, 0.005).apply(1, 1, pairs, 0);
    for (std::size_t i = 0; i < groups.size(); ++i)
        EXPECT_NEAR(groups[i], pairs[i], 5e-3f);
}

TEST(Diffusion, OverATinyAreaIsAreaTimesTheDipoleCenter) {
    // A triangle with legs of a thousandth of a mean free path, over which the dipole hardly falls.
    const float leg = 1e-5f;
    Plane speck;
    speck.receivers.positions = {{0, 0, 0}, {0, 0, leg}, {leg, 0, 0}};
    speck.receivers.normals.assign(3, {0, 1, 0});
    speck.receivers.areas.assign(3, leg * leg / 6);
    speck.triangles = {{0, 1, 2}};
    const glm::dvec3 scattering(90, 80, 70), absorption(10, 20, 30);
    std::vector<float> values = {1, 1, 1, 2, 2, 2, 6, 6, 6}; // [receivers][channels], 3 in the mean
    operator_on(speck, {scattering, absorption, 1.3}).apply(3, 1, values, 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int c = static_cast<int>(i % 3);
        const Dipole dipole(scattering[c], absorption[c], 1.3);
        const double expected =
            3 * static_cast<double>(leg * leg) / 2 * dipole.reflectance(0) / dipole.total();
        EXPECT_NEAR(static_cast<double>(values[i]), expected, 1e-4 * expected);
    }
}

TEST(Diffusion, SumsDistantTrianglesByArea) {
    // A dark triangle, and two distant ones, so near each other that they are merged.
    Plane scattered;
    const auto add = [&](float x, float leg) {
        const auto first = static_cast<unsigned>(scattered.receivers.size());
        for (const glm::vec3& p : {glm::vec3(x, 0, 0), glm::vec3(x, 0, leg), glm::vec3(x + leg, 0, 0)}) {
            scattered.receivers.positions.push_back(p);
            scattered.receivers.normals.emplace_back(0, 1, 0);
            scattered.receivers.areas.push_back(leg * leg / 6);
        }
        scattered.triangles.emplace_back(first, first + 1, first + 2);
    };
    constexpr float kLegs[] = {0.01f, 0.02f, 0.04f}, kPositions[] = {0, 2, 2.02f}, kLight[] = {0, 5, 1};
    for (std::size_t t = 0; t < 3; ++t)
        add(kPositions[t], kLegs[t]);
    std::vector<float> values;
    for (const float light : kLight)
        values.insert(values.end(), 3, light);
    operator_on(scattered, {glm::dvec3(0.9), glm::dvec3(0.1), 1.3}).apply(1, 1, values, 1);
    const Dipole dipole(0.9, 0.1, 1.3);
    double expected = 0;
    for (std::size_t t = 1; t < 3; ++t)
        expected += static_cast<double>(kLight[t] * kLegs[t] * kLegs[t] / 2) *
                    dipole.reflectance(static_cast<double>(kPositions[t] + kLegs[t] / 3)) / dipole.total();
    EXPECT_NEAR(static_cast<double>(values[0]), expected, 0.02 * expected);
}

TEST(Subsurface, BlursShadowsAndKeepsTheirLight) {
    const Scene scene = test::SceneBuilder().floor({0, 0, 0}, 1, 24).sphere({0, 0.4f, 0}, 0.2f, 12).build();
    BakeOptions options;
    options.order = 2;
    options.rays = 256;
    options.tracer.backend = Backend::cpu;
    const auto visibility = [&] {
        const Transfer t = bake(scene, options).baked.transfer;
        return std::pair(exit_radiance(t, constant_light(2, glm::vec3(1))),
                         mean_visibility(t, receiver_areas(scene)));
    };
    const auto [sharp, sharp_mean] = visibility();
    options.subsurface.media = {{"", {glm::dvec3(20, 30, 40), glm::dvec3(0.5), 1.3}}};
    const auto [soft, soft_mean] = visibility();
    float darkest_sharp = 1, darkest_soft = 1;
    for (std::size_t p = 0; p < 24 * 24 * 6; ++p) {
        const glm::vec3& at = scene.vertex_arrays[0].positions[p];
        if (std::max(std::abs(at.x), std::abs(at.z)) > 0.6f)
            continue;
        darkest_sharp = std::min(darkest_sharp, sharp[p].x);
        darkest_soft = std::min(darkest_soft, soft[p].x);
    }
    EXPECT_GT(darkest_soft, darkest_sharp + 0.005f);
    EXPECT_LT(darkest_soft, 0.95f); // the shadow is still there
    // A vertex in the corner of the floor has a quarter of a plane round it, to which light spreads.
    EXPECT_NEAR(soft[0].x, sharp[0].x / 4, 0.01f);
    EXPECT_NEAR(soft_mean, sharp_mean, 0.1 * sharp_mean); // except for light lost over the floor's edge
}

TEST(Subsurface, AdjacentBodiesAreIndependent) {
    // In one plane, so that neither shades the other.
    const Scene small = test::SceneBuilder().floor({0, 0, 0}, 0.1f, 4).build(),
                large = test::SceneBuilder().floor({1, 0, 0}, 0.2f, 3).build();
    BakeOptions options;
    options.order = 2;
    options.rays = 16;
    options.tracer.backend = Backend::cpu;
    options.subsurface.media = {{"", {glm::dvec3(20, 30, 40), glm::dvec3(0.5), 1.3}}};
    const auto baked = [&](const Scene& scene) { return bake(scene, options).baked.transfer.vectors; };
    std::vector<float> expected = baked(small);
    const std::vector<float> second = baked(large), both = baked(test::join({small, large}));
    expected.insert(expected.end(), second.begin(), second.end());
    ASSERT_EQ(both.size(), expected.size());
    for (std::size_t i = 0; i < both.size(); ++i)
        EXPECT_NEAR(both[i], expected[i], 1e-6f) << i;
}

/// Bakes a triangle filled with a medium with these coefficients in red, and with 2000/m in green and blue.
Transfer bake_medium(double scattering, double absorption) {
    BakeOptions options;
    options.order = 2;
    options.rays = 16;
    options.subsurface.media = {
        {"", {glm::dvec3(scattering, 1000, 1000), glm::dvec3(absorption, 1000, 1000)}}};
    return bake(test::SceneBuilder().triangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}).build(), options)
        .baked.transfer;
}

TEST(Subsurface, IsFiniteForExtremeMedia) {
    for (const double scattering : {kMinScattering, kMaxCoefficient})
        for (const double absorption : {0.0, kMinScattering, kMaxCoefficient})
            for (const float v : bake_medium(scattering, absorption).vectors)
                ASSERT_TRUE(std::isfinite(v)) << scattering << " " << absorption;
}

TEST(Subsurface, RejectsInvalidMedia) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, 2 * kMaxCoefficient, 1e41, infinity, nan}) {
        EXPECT_THROW(bake_medium(bad, 1), Error) << bad;
        EXPECT_THROW(bake_medium(1, bad), Error) << bad;
    }
    EXPECT_THROW(bake_medium(0, 1), Error);
}

TEST(Subsurface, ComesFromTheMaterialsVolume) {
    Material wax;
    wax.base_color = {0.8f, 0.6f, 0.3f, 1};
    wax.transmission.factor = 1;
    wax.volume = {1, 0.01f, {0.5f, 0.5f, 0.5f}};
    const auto medium = medium_of(wax);
    ASSERT_TRUE(medium);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(medium->scattering[c] + medium->absorption[c], std::log(2) / 0.01, 1e-3);
        EXPECT_NEAR(Dipole(medium->scattering[c], medium->absorption[c], 1.5).total(),
                    static_cast<double>(wax.base_color[c]), 1e-6);
    }
    wax.volume.thickness = 0; // a thin sheet has no inside
    EXPECT_FALSE(medium_of(wax));
}

} // namespace
} // namespace prt
