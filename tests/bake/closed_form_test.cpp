// Compares transfer with closed forms.

#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "support/quadrature.h"
#include "support/scene_builder.h"
#include "support/traced.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Transfer of one receiver in front of `scene`.
std::vector<float> transfer_at(const Scene& scene, const glm::vec3& position, const glm::vec3& normal,
                               int order, int rays) {
    return test::traced_at(TraceScene(scene), position, normal, {.order = order, .rays = rays, .seed = 1})
        .vectors;
}

class OpenReceiver : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, OpenReceiver, testing::Range(1, kMaxOrder + 1));

TEST_P(OpenReceiver, HasTheClampedCosineLobeWithoutNoise) {
    const int order = GetParam();
    const Scene floor = test::SceneBuilder().floor({0, 0, 0}, 5).build();
    for (const glm::vec3& normal : {glm::vec3(0, 1, 0), glm::normalize(glm::vec3(0.01f, 1, -0.02f))}) {
        // Tilted, some rays would meet the floor: lift the receiver over the edge instead.
        const glm::vec3 position = normal.x == 0 ? glm::vec3(0.3f, 0, 0.2f) : glm::vec3(0, 2, 0);
        const auto t =
            transfer_at(normal.x == 0 ? floor : test::SceneBuilder().floor({0, -50, 0}, 0.1f).build(),
                        position, normal, order, 256);
        std::array<double, 100> lobe{};
        clamped_cosine_lobe(order, glm::dvec3(normal), lobe);
        for (std::size_t i = 0; i < t.size(); ++i)
            EXPECT_NEAR(static_cast<double>(t[i]), lobe[i], 1e-7) << i;
    }
}

TEST(BlockedReceiver, HasExactlyZero) {
    const Scene box = test::SceneBuilder().sphere({0, 0, 0}, 1, 16).build();
    for (const float value : transfer_at(box, {0.1f, 0.2f, 0}, {0, 1, 0}, 6, 1000))
        EXPECT_EQ(value, 0);
}

/// Returns 2 ∫_c^1 t K_l P_l(t) dt for c = cos(blocked angle), with K_l the norm of Y_l0: the transfer that a
/// coaxial cap of blocked directions removes, in closed form by t P_l = ((l+1) P_{l+1} + l P_{l-1}) / (2l+1)
/// and ∫ P_n = (P_{n+1} - P_{n-1}) / (2n+1).
double cap_transfer(int l, double c) {
    const auto p = [](int n, double t) { return n < 0 ? 1.0 : std::legendre(static_cast<unsigned>(n), t); };
    const auto integral = [&](int n) { return n == 0 ? 1 - c : (p(n - 1, c) - p(n + 1, c)) / (2 * n + 1); };
    const double inner = ((l + 1) * integral(l + 1) + (l > 0 ? l * integral(l - 1) : 0)) / (2 * l + 1);
    return 2 * inner * std::sqrt((2 * l + 1) / (4 * pi));
}

TEST(DiscBlocker, BlocksItsCap) {
    const float height = 2, radius = 1.5f;
    const Scene disc = test::SceneBuilder().disc({0, 0, height}, {0, 0, -1}, radius, 2000).build();
    const auto t = transfer_at(disc, {0, 0, 0}, {0, 0, 1}, 8, 1 << 18);
    const double c = height / std::hypot(height, radius);
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(8, {0, 0, 1}, lobe);
    for (int l = 0; l < 8; ++l)
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            EXPECT_NEAR(static_cast<double>(t[i]), m == 0 ? lobe[i] - cap_transfer(l, c) : 0, 2e-5)
                << l << ", " << m;
        }
}

TEST(SphereBlocker, IsADiscOfTheSameAngle) {
    const Scene sphere = test::SceneBuilder().sphere({0, 0, 3}, 1, 400).build();
    const auto t = transfer_at(sphere, {0, 0, 0}, {0, 0, 1}, 6, 1 << 16);
    const double c = std::sqrt(1 - 1.0 / 9);
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(6, {0, 0, 1}, lobe);
    for (int l = 0; l < 6; ++l)
        EXPECT_NEAR(static_cast<double>(t[static_cast<std::size_t>(sh_index(l, 0))]),
                    lobe[static_cast<std::size_t>(sh_index(l, 0))] - cap_transfer(l, c), 1e-4)
            << l;
}

TEST(EndlessWall, BlocksHalfOfTheSky) {
    // A receiver that looks up +Z at the foot of a wall in x = 0 sees x > 0 only.
    constexpr float kFar = 1e5f;
    const Scene wall =
        test::SceneBuilder().quad({0, -kFar, -1}, {0, kFar, -1}, {0, kFar, kFar}, {0, -kFar, kFar}).build();
    const auto t = transfer_at(wall, {1e-3f, 0, 0}, {0, 0, 1}, 6, 1 << 16);
    EXPECT_NEAR(t[0], 0.282095 / 2, 1e-4);
    EXPECT_NEAR(t[1], 0, 1e-4);
    EXPECT_NEAR(t[2], 0.488603 / 3, 1e-4);
    EXPECT_NEAR(t[3], -0.488603 * 2 / (3 * pi), 1e-4);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double integral = test::integrate_sphere(400, [&](const glm::dvec3& w) {
            std::array<double, 100> y{};
            evaluate_sh(6, w, std::span<double>(y));
            return w.x > 0 ? std::max(0.0, w.z) * y[i] / pi : 0.0;
        });
        EXPECT_NEAR(static_cast<double>(t[i]), integral, 2e-4) << i;
    }
}

TEST(Uniform, LightOfRadianceOneEqualsVisibility) {
    // A receiver in the middle of a square pit of slope 45 degrees sees sin²(45°) = half of the
    // cosine-weighted sky of a cone; a pyramid with many sides approximates a cone.
    test::SceneBuilder builder;
    constexpr int kSides = 720;
    for (int i = 0; i < kSides; ++i) {
        const auto rim = [&](int k) {
            const double a = 2 * pi * k / kSides;
            return glm::vec3(std::cos(a), std::sin(a), 0);
        };
        builder.quad(rim(i) * 1.0f, rim(i + 1) * 1.0f, rim(i + 1) + glm::vec3(0, 0, 1),
                     rim(i) + glm::vec3(0, 0, 1));
    }
    const auto t = transfer_at(builder.build(), {0, 0, 0}, {0, 0, 1}, 1, 1 << 16);
    EXPECT_NEAR(t[0] / 0.28209479, 0.5,
                1e-4); // the wall of height 1 at distance 1 leaves the cone of 45 degrees open
}

TEST(WallFoot, SeesHalfTheSkyForAllWallSides) {
    // Vertices of the floor are in the plane of the wall, exactly or up to rounding.
    for (const bool double_sided : {false, true})
        for (const float shift : {0.0f, 0.1f, 1000.3f}) {
            const glm::vec3 at(shift, 0, 0.7f * shift);
            Scene scene = test::SceneBuilder()
                              .quad(at + glm::vec3(0, 0, 100), at + glm::vec3(200, 0, 100),
                                    at + glm::vec3(200, 0, -100), at + glm::vec3(0, 0, -100))
                              .quad(at + glm::vec3(0, 0, 9999), at + glm::vec3(0, 0, -9999),
                                    at + glm::vec3(0, 9999, -9999), at + glm::vec3(0, 9999, 9999))
                              .build();
            scene.materials[0].double_sided = double_sided;
            BakeOptions options;
            options.tracer.backend = Backend::cpu;
            options.order = 1;
            const BakeResult result = bake(scene, options);
            EXPECT_EQ(result.statistics.receivers.sealed, 0u);
            for (const std::size_t foot : {0u, 3u, 5u}) { // the vertices of the floor at the wall
                const auto seen =
                    static_cast<double>(result.baked.transfer.vector(foot)[0]) * std::sqrt(4 * pi);
                EXPECT_NEAR(seen, 0.5, 0.01) << shift << " " << foot;
            }
        }
}

} // namespace
} // namespace prt
