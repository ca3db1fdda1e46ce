// Ambient occlusion, obscurance and bent normals against closed forms and quadrature.

#include "prt/bake/ambient_occlusion.h"

#include "prt/core/error.h"
#include "support/quadrature.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder;

constexpr double kTall = 1000; ///< height that approximates infinity

OcclusionOptions at_vertices(int rays = 16384) {
    OcclusionOptions options;
    options.rays = rays;
    options.fit = FitMode::vertex;
    return options;
}

/// Returns a small floor triangle that faces up; its first vertex is at the origin.
Scene spot() {
    return SceneBuilder().triangle({0, 0, 0}, {-0.01f, 0, 0.01f}, {0.01f, 0, 0.01f}).build();
}

/// A wall at z = -distance, of that height, that looks at the spot.
Scene wall(float distance, float height) {
    const auto far = static_cast<float>(kTall);
    return SceneBuilder()
        .quad({-far, -1, -distance}, {far, -1, -distance}, {far, height, -distance},
              {-far, height, -distance})
        .build();
}

TEST(AmbientOcclusion, IsOneWithVerticalBentNormalAtOpenVertices) {
    const OcclusionResult result = ambient_occlusion(spot(), at_vertices(64));
    EXPECT_NEAR(result.ambient_visibility.ambient[0], 1, 1e-5);
    EXPECT_NEAR(result.ambient_visibility.bent_normals[0].y, 1, 1e-5);
}

TEST(AmbientOcclusion, UnderADiscIsItsFormFactor) {
    const double h = 0.7, r = 0.9;
    const Scene scene =
        test::join({spot(), SceneBuilder().disc({0, 0.7f, 0}, {0, -1, 0}, 0.9f, 512).build()});
    const OcclusionResult result = ambient_occlusion(scene, at_vertices());
    EXPECT_NEAR(result.ambient_visibility.ambient[0], 1 - r * r / (r * r + h * h), 2e-3);
    EXPECT_NEAR(result.ambient_visibility.bent_normals[0].y, 1, 2e-3);
}

TEST(AmbientOcclusion, MatchesTheHeightOfAnEndlessWall) {
    for (const double elevation : {20.0, 60.0, 89.9}) {
        const double angle = elevation / 180 * std::numbers::pi;
        const float distance = 0.1f, height = distance * static_cast<float>(std::tan(angle));
        const OcclusionResult result =
            ambient_occlusion(test::join({spot(), wall(distance, height)}), at_vertices());
        EXPECT_NEAR(result.ambient_visibility.ambient[0], (1 + std::cos(angle)) / 2, 3e-3) << elevation;
        // Mean direction of light, by quadrature over the directions that the wall leaves open.
        glm::dvec3 mean(0);
        for (int axis = 0; axis < 3; ++axis)
            mean[axis] = test::integrate_sphere(400, [&](const glm::dvec3& d) {
                const bool open = d.y > 0 && !(d.z < 0 && d.y < -d.z * std::tan(angle));
                return open ? d.y * d[axis] : 0.0;
            });
        const glm::dvec3 expected = glm::normalize(mean);
        EXPECT_LT(glm::distance(glm::dvec3(result.ambient_visibility.bent_normals[0]), expected), 1e-2)
            << elevation;
    }
}

/// Returns the occlusion by a plane at that height over the spot: ∫ ρ(h / cos θ) 2 cos θ sin θ dθ.
double under_a_plane(const Falloff& falloff, double height) {
    constexpr int kSteps = 100000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps; // cos θ
        sum += falloff.passes(height / c) * 2 * c / kSteps;
    }
    return sum;
}

Scene under_a_wide_plane(float height) {
    const auto far = static_cast<float>(kTall);
    return test::join(
        {spot(), SceneBuilder()
                     .quad({-far, height, -far}, {far, height, -far}, {far, height, far}, {-far, height, far})
                     .build()});
}

TEST(Obscurance, UnderAPlaneIsTheIntegralOfTheFalloff) {
    for (const Falloff& falloff : {Falloff{.terms = {{2, 1}}}, Falloff{.terms = {{2, 0.97}, {300, 0.03}}},
                                   Falloff{.terms = {{2, 97}, {300, 3}}}, Falloff{.terms = {}, .farthest = 3},
                                   Falloff{.terms = {{0.5, 1}}, .farthest = 4}})
        for (const float height : {0.1f, 1.5f}) {
            OcclusionOptions options = at_vertices();
            options.tracer.falloff = falloff;
            const OcclusionResult result = ambient_occlusion(under_a_wide_plane(height), options);
            EXPECT_NEAR(result.ambient_visibility.ambient[0],
                        under_a_plane(falloff, static_cast<double>(height)), 3e-3)
                << height;
            if (result.ambient_visibility.ambient[0] >
                0.05f) { // below that, few rays determine the direction
                EXPECT_NEAR(result.ambient_visibility.bent_normals[0].y, 1, 1e-2);
            }
        }
}

TEST(Obscurance, ClosedRoomsAreNotBlack) {
    Scene room = SceneBuilder().bowl({0, 0, 0}, 2, 12, 0).build();
    EXPECT_EQ(ambient_occlusion(room, at_vertices(64)).ambient_visibility.ambient[20], 0);
    OcclusionOptions options = at_vertices(4096);
    options.tracer.falloff.terms = {{2, 1}};
    // From a point on a sphere, the distance to the hit at angle θ is 2 R cos θ.
    double expected = 0;
    constexpr int kSteps = 10000;
    for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        expected += (1 - std::exp2(-2 * 2 * c / 2)) * 2 * c / kSteps;
    }
    double mean = 0;
    const OcclusionResult result = ambient_occlusion(room, options);
    for (const float v : result.ambient_visibility.ambient)
        mean += static_cast<double>(v) / static_cast<double>(result.ambient_visibility.ambient.size());
    EXPECT_NEAR(mean, expected, 0.03 * expected); // twelve rows are not quite round
}

TEST(Obscurance, InsideSolidsComesFromNeighbors) {
    // A floor that passes through a closed block: receivers inside take the light of those outside.
    Scene floor = SceneBuilder().floor({0, 0, 0}, 2, 8).build(),
          block = SceneBuilder().sphere({0, 0, 0}, 0.8f, 16).build();
    OcclusionOptions options = at_vertices(1024);
    options.tracer.falloff.terms = {{5, 1}};
    const OcclusionResult result = ambient_occlusion(test::join({floor, block}), options);
    EXPECT_GT(result.statistics.receivers.sealed, 0u);
    const std::vector<glm::vec3>& positions = floor.vertex_arrays[0].positions;
    for (std::size_t v = 0; v < positions.size(); ++v)
        EXPECT_GT(result.ambient_visibility.ambient[v], 0.3f) << positions[v].x << " " << positions[v].z;
}

TEST(Falloff, PassesHalfAtItsDistance) {
    EXPECT_TRUE(Falloff{}.blocks_everywhere());
    EXPECT_EQ(Falloff{}.passes(1e9), 0);
    const Falloff mixed{.terms = {{2, 97}, {300, 3}}};
    EXPECT_EQ(mixed.passes(0), 0);
    EXPECT_NEAR(mixed.passes(2), 0.97 * 0.5 + 0.03 * (1 - std::exp2(-2.0 / 300)), 1e-12);
    EXPECT_NEAR(mixed.passes(1e6), 1, 1e-9);
    EXPECT_EQ((Falloff{.terms = {}, .farthest = 3}).passes(3.1), 1);
    EXPECT_EQ((Falloff{.terms = {}, .farthest = 3}).passes(2.9), 0);
}

TEST(Falloff, RejectsInvalidDistances) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Falloff& bad : {Falloff{.terms = {{0, 1}}}, Falloff{.terms = {{nan, 1}}},
                               Falloff{.terms = {{1, -1}}}, Falloff{.terms = {{1, 0}}},
                               Falloff{.terms = {}, .farthest = 0}, Falloff{.terms = {}, .farthest = nan}})
        EXPECT_THROW(check_falloff(bad), Error);
    BakeOptions options;
    options.tracer.falloff.terms = {{2, 1}};
    options.bounces = 1;
    EXPECT_THROW(bake(spot(), options), Error);
}

} // namespace
} // namespace prt
