// Tests occlusion by moving objects: caps against quadrature and spheres, and placed volumes.

#include "prt/core/occlusion_volume.h"

#include "prt/core/error.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace prt {
namespace occlusion_volumes { // joined sources share one scope
namespace {

constexpr double kPi = std::numbers::pi;

glm::vec3 any_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(glm::vec3(x, y, z) + glm::vec3(1e-3f, 0, 0));
}

/// Returns the volume of a ball about the origin, in closed form at its texels.
OcclusionVolume ball(float radius) {
    OcclusionVolume volume;
    volume.low = glm::vec3(-4 * radius);
    volume.high = glm::vec3(4 * radius);
    volume.reach = 12 * radius;
    for (int i = 0; i < static_cast<int>(kOccluderTexels); ++i) {
        const glm::vec3 at(i % 8, i / 8 % 8, i / 64);
        const glm::vec3 position = volume.low + at / 7.0f * (volume.high - volume.low);
        const float ratio = std::min(radius / glm::length(position), 1.0f);
        volume.texels[static_cast<std::size_t>(i)] =
            occluder_texel(0.5f * (1 - std::sqrt(1 - ratio * ratio)), -glm::normalize(position));
    }
    return volume;
}

TEST(BlockedCap, IsReconstructedFromMoments) {
    for (const double share : {0.01, 0.3, 0.5, 0.8, 0.99}) {
        // Brute force: the mean of directions in the cap about +z, over share (1 - share).
        const double mean =
            test::integrate_sphere(400, [&](const glm::dvec3& w) { return w.z > 1 - 2 * share ? w.z : 0; }) /
            (4 * kPi);
        const BlockedCap cap =
            cap_of(static_cast<float>(share), {0, 0, static_cast<float>(mean / (share * (1 - share)))});
        EXPECT_NEAR(cap.share, share, 1e-2);
        EXPECT_NEAR(cap.density, 1, 1e-2);
        EXPECT_NEAR(cap.towards.z, 1, 1e-6);
    }
}

TEST(BlockedCap, KeepsItsMomentsIfPartlyBlocked) {
    const BlockedCap cap = cap_of(0.2f, {0.3f, 0, 0});
    EXPECT_NEAR(cap.density * cap.share, 0.2, 1e-6);
    // Mean direction: density · share (1 - share).
    EXPECT_NEAR(cap.density * cap.share * (1 - cap.share), 0.2 * 0.8 * 0.3, 1e-6);
    EXPECT_FLOAT_EQ(cap.towards.x, 1);
}

TEST(BlockedCap, BlocksNoLightIfEmpty) {
    EXPECT_EQ(blocked_cosine(cap_of(0, {0, 0, 0}), {0, 1, 0}), 0);
    EXPECT_EQ(blocked_cosine(cap_of(0, {1, 0, 0}), {1, 0, 0}), 0);
    EXPECT_EQ(blocked_sun(cap_of(0, {1, 0, 0}), {1, 0, 0}, 0), 0);
}

TEST(BlockedCap, BlocksTheCosineWeightedPartAboveTheHorizon) {
    for (const float share : {0.02f, 0.1f, 0.25f, 0.4f, 0.5f, 0.6f, 0.75f, 0.95f})
        for (double angle = 0; angle <= 180; angle += 15) {
            const glm::dvec3 normal(std::sin(angle * kPi / 180), 0, std::cos(angle * kPi / 180));
            const BlockedCap cap{{0, 0, 1}, share, 0.7f};
            const double expected =
                0.7 / kPi * test::integrate_sphere(500, [&](const glm::dvec3& w) {
                    return w.z > 1 - 2 * static_cast<double>(share) ? std::max(0.0, glm::dot(w, normal)) : 0;
                });
            EXPECT_NEAR(blocked_cosine(cap, glm::vec3(normal)), expected, 3e-3) << share << " " << angle;
        }
}

TEST(BlockedCap, HasTheFormFactorOfASphereAbove) {
    const double ratio = 0.6; // ratio of radius to distance: the form factor is its square
    const auto share = static_cast<float>(0.5 * (1 - std::sqrt(1 - ratio * ratio)));
    EXPECT_NEAR(blocked_cosine(cap_of(share, {0, 1, 0}), {0, 1, 0}), ratio * ratio, 1e-5);
}

TEST(BlockedCap, HidesASunInItsMiddleAndNotOneBehindTheReceiver) {
    const BlockedCap cap{{0, 1, 0}, 0.1f, 0.8f};
    EXPECT_FLOAT_EQ(blocked_sun(cap, {0, 1, 0}, 0), 0.8f);
    EXPECT_EQ(blocked_sun(cap, {0, -1, 0}, 0), 0);
    float before = 1;
    for (float angle = 0; angle < 3.1f; angle += 0.05f) {
        const float now = blocked_sun(cap, {std::sin(angle), std::cos(angle), 0}, 0.01f);
        EXPECT_LE(now, before + 1e-6f);
        before = now;
    }
}

TEST(OcclusionVolume, MatchesABall) {
    const OcclusionVolume volume = ball(0.5f);
    const glm::vec3 center(3, -2, 7);
    const PlacedOccluder where = placed(volume, glm::translate(glm::mat4(1), center), 0);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> distance(0.9f, 3.5f);
    double error = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 out = any_direction(random), normal = any_direction(random);
        const float d = distance(random);
        const float ratio = 0.5f / d;
        const BlockedCap exact = cap_of(0.5f * (1 - std::sqrt(1 - ratio * ratio)), -out);
        error +=
            std::abs(static_cast<double>(blocked_cosine(blocked_at(volume, where, center + d * out), normal) -
                                         blocked_cosine(exact, normal)));
    }
    EXPECT_LT(error / 2000, 0.01); // texels as wide as the ball
}

TEST(OcclusionVolume, FadesToZeroAtADistance) {
    const OcclusionVolume volume = ball(0.5f);
    const PlacedOccluder where = placed(volume, glm::mat4(1), 0);
    float before = 1;
    for (float d = 1; d < 8; d += 0.05f) {
        const float now = blocked_cosine(blocked_at(volume, where, {0, -d, 0}), {0, 1, 0});
        EXPECT_LE(now, before + 2e-3f) << d; // rounding of eight bits
        EXPECT_LT(std::abs(now - before), d < 1.1f ? 1 : 0.1f);
        before = now;
    }
    EXPECT_EQ(blocked_at(volume, where, {0, -6, 0}).density, 0);
    EXPECT_EQ(blocked_at(volume, where, {1e6f, 1e6f, 0}).density, 0);
}

TEST(OcclusionVolume, IsContinuousAtItsBoundary) {
    std::mt19937 random(2);
    OcclusionVolume volume = ball(0.5f);
    std::uniform_int_distribution<int> any(-127, 127);
    for (OccluderTexel& texel : volume.texels)
        for (std::int8_t& n : texel)
            n = static_cast<std::int8_t>(any(random));
    const PlacedOccluder where = placed(volume, glm::mat4(1), 0);
    for (int i = 0; i < 500; ++i) {
        glm::vec3 face = 2.0f * any_direction(random);
        face[i % 3] = i % 2 ? 2.0f : -2.0f;
        const glm::vec3 normal = any_direction(random);
        EXPECT_NEAR(blocked_cosine(blocked_at(volume, where, 0.99999f * face), normal),
                    blocked_cosine(blocked_at(volume, where, 1.00001f * face), normal), 1e-3);
    }
}

TEST(OcclusionVolume, TransformsWithItsObject) {
    std::mt19937 random(3);
    OcclusionVolume volume = ball(0.5f);
    volume.low = {-1, -2, -0.5f}; // no symmetry
    volume.high = {2, 1.5f, 0.7f};
    const glm::mat4 rotation = glm::rotate(glm::mat4(1), 1.1f, glm::normalize(glm::vec3(1, 2, 3)));
    const glm::mat4 moved = glm::scale(glm::translate(glm::mat4(1), {5, 6, 7}) * rotation, glm::vec3(100.0f));
    const PlacedOccluder at_home = placed(volume, glm::mat4(1), 0), away = placed(volume, moved, 0);
    EXPECT_NEAR(glm::distance(away.center(), glm::vec3(moved * glm::vec4(0.5f, -0.25f, 0.1f, 1))), 0, 1e-3);
    EXPECT_NEAR(away.reach(), 100 * volume.reach, 1e-2);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 position = 3.0f * any_direction(random), normal = any_direction(random);
        const float home = blocked_cosine(blocked_at(volume, at_home, position), normal);
        const float there =
            blocked_cosine(blocked_at(volume, away, glm::vec3(moved * glm::vec4(position, 1))),
                           glm::vec3(rotation * glm::vec4(normal, 0)));
        EXPECT_NEAR(home, there, 1e-4);
    }
}

TEST(OcclusionVolume, ZeroScaleDoesNotBlock) {
    const PlacedOccluder where = placed(ball(1), glm::mat4(0), 0);
    EXPECT_EQ(blocked_at(ball(1), where, {0, 0, 0}).density, 0);
}

TEST(OcclusionVolume, InvalidBoxesAreRejected) {
    OcclusionVolume volume = ball(1);
    check_occlusion_volume(volume);
    volume.high.y = volume.low.y;
    EXPECT_THROW(check_occlusion_volume(volume), Error);
    volume = ball(1);
    volume.reach = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(check_occlusion_volume(volume), Error);
    volume = ball(1);
    volume.high.x = std::numeric_limits<float>::infinity();
    EXPECT_THROW(check_occlusion_volume(volume), Error);
}

TEST(OccluderList, ContainsTheNearestOccludersThatReachABox) {
    const OcclusionVolume volume = ball(0.5f); // reach 6
    std::vector<PlacedOccluder> all;
    for (const float x : {30.0f, 5.0f, 7.5f, 2.0f})
        all.push_back(placed(volume, glm::translate(glm::mat4(1), glm::vec3(x, 0, 0)), 0));
    const glm::vec3 low(-1), high(1);
    EXPECT_EQ(occluders_near(all, low, high, 8), (std::vector<std::uint32_t>{3, 1}));
    EXPECT_EQ(occluders_near(all, low, high, 1), (std::vector<std::uint32_t>{3}));
    EXPECT_TRUE(occluders_near({}, low, high, 8).empty());
}

} // namespace
} // namespace occlusion_volumes
} // namespace prt
