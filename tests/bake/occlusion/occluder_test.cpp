// Occlusion volumes of objects, baked, against closed forms and rays.

#include "prt/bake/ambient_occlusion.h"

#include "prt/core/error.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace baked_occluders { // joined sources share one scope
namespace {

using test::SceneBuilder;

glm::vec3 any_direction(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(glm::vec3(x, y, z) + glm::vec3(1e-3f, 0, 0));
}

/// Returns the occlusion by a sphere with this ratio of radius to distance, for a receiver in direction `out`
/// of it.
float of_ball(float ratio, const glm::vec3& out, const glm::vec3& normal) {
    return blocked_cosine(cap_of(0.5f * (1 - std::sqrt(1 - ratio * ratio)), -out), normal);
}

TEST(Occluder, MatchesABall) {
    const glm::vec3 center(2, 1, -3);
    const Scene scene = SceneBuilder().sphere(center, 0.5f, 24).build();
    const OccluderBake baked = bake_occluder(scene, glm::dmat4(1), {.rays = 128});
    const PlacedOccluder where = placed(baked.volume, glm::mat4(1), 0);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> distance(0.55f, 2);
    double mean = 0;
    float largest_far = 0;
    constexpr int kCount = 2000;
    for (int i = 0; i < kCount; ++i) {
        const glm::vec3 out = any_direction(random), normal = any_direction(random);
        const float d = distance(random);
        const float error =
            std::abs(blocked_cosine(blocked_at(baked.volume, where, center + d * out), normal) -
                     of_ball(0.5f / d, out, normal));
        mean += static_cast<double>(error) / kCount;
        if (d > 1)
            largest_far = std::max(largest_far, error);
    }
    EXPECT_LT(mean, 0.02); // texels have a spacing of 0.31 m
    EXPECT_LT(largest_far, 0.06);
    EXPECT_LT(baked.mean_error, 0.02);
    EXPECT_GT(baked.mean_blocked, 0.04);
}

TEST(Occluder, EffectVanishesAtADistance) {
    const Scene scene = SceneBuilder().sphere({0, 0, 0}, 0.5f, 24).build();
    const OccluderBake baked = bake_occluder(scene, glm::dmat4(1), {.rays = 128});
    const PlacedOccluder where = placed(baked.volume, glm::mat4(1), 0);
    std::mt19937 random(2);
    for (float d = 1.4f; d < 12; d *= 1.15f) {
        const glm::vec3 out = any_direction(random);
        const float found = blocked_cosine(blocked_at(baked.volume, where, d * out), -out);
        // The form factor is (r / d)²; the cut at the end of the reach is at most 1 % times the square of 1 /
        // 0.6.
        EXPECT_NEAR(found, 0.25f / (d * d), 0.2f * 0.25f / (d * d) + 0.028f) << d;
        if (d > 1.01f * baked.volume.reach) {
            EXPECT_EQ(found, 0) << d;
        }
    }
    EXPECT_LT(baked.volume.reach, 8); // (0.25 / 0.01)^(1/2) = 5
}

TEST(Occluder, DoesNotDependOnRotationAndScaleOfItsFrame) {
    const Scene scene = test::join({SceneBuilder().sphere({0.3f, 0.8f, 0}, 0.3f, 12).build(),
                                    SceneBuilder().sphere({-0.2f, 0.2f, 0.4f}, 0.2f, 12).build()});
    const glm::dmat4 frame = glm::scale(glm::rotate(glm::translate(glm::dmat4(1), {0.1, 0.5, 0.2}), 0.7,
                                                    glm::normalize(glm::dvec3(1, -1, 2))),
                                        glm::dvec3(0.01));
    const OccluderBake plain = bake_occluder(scene, glm::dmat4(1), {.rays = 128}),
                       framed = bake_occluder(scene, frame, {.rays = 128});
    const PlacedOccluder a = placed(plain.volume, glm::mat4(1), 0),
                         b = placed(framed.volume, glm::mat4(frame), 0);
    std::mt19937 random(3);
    double mean = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 position = glm::vec3(0, 0.5f, 0.2f) + 1.2f * any_direction(random),
                        normal = any_direction(random);
        mean +=
            std::abs(static_cast<double>(blocked_cosine(blocked_at(plain.volume, a, position), normal) -
                                         blocked_cosine(blocked_at(framed.volume, b, position), normal))) /
            1000;
    }
    EXPECT_LT(mean, 0.01);
}

TEST(Occluder, PiecesTogetherMatchRays) {
    const Scene left = SceneBuilder().sphere({-0.6f, 0.45f, 0}, 0.4f, 16).build(),
                right = SceneBuilder().sphere({0.6f, 0.45f, 0}, 0.4f, 16).build();
    const Scene both = test::join({left, right});
    const OcclusionVolume volumes[] = {bake_occluder(left, glm::dmat4(1)).volume,
                                       bake_occluder(right, glm::dmat4(1)).volume};
    const glm::dmat4 frames[] = {glm::dmat4(1), glm::dmat4(1)};
    const FloorOcclusion floor = floor_occlusion(both, volumes, frames);
    EXPECT_GT(floor.mean_blocked, 0.05);
    EXPECT_LT(floor.mean_error, 0.02);
    const FloorOcclusion none = floor_occlusion(both, {}, {});
    EXPECT_NEAR(none.mean_error, floor.mean_blocked, 1e-3); // there is that much to be wrong about
}

TEST(Occluder, WithoutExtentOrScaleIsRejected) {
    const Scene scene = SceneBuilder().sphere({0, 0, 0}, 0.5f, 8).build();
    EXPECT_THROW(bake_occluder(scene, glm::dmat4(0)), Error);
}

} // namespace
} // namespace baked_occluders
} // namespace prt
