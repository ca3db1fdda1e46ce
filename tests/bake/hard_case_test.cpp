// Tests bakes of degenerate geometry and extreme scales.

#include "bake/scene/small_objects.h"
#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"
#include "support/traced.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace prt {
namespace {

using test::SceneBuilder;

Transfer bake_scene(const Scene& scene, int rays = 256, int order = 4) {
    BakeOptions options;
    options.order = order;
    options.rays = rays;
    return bake(scene, options).baked.transfer;
}

void expect_finite(const Transfer& transfer) {
    for (const float v : transfer.vectors)
        EXPECT_TRUE(std::isfinite(v));
}

/// Whether receiver `p` has exactly the lobe of an open one with normal +Y.
void expect_open(const Transfer& transfer, std::size_t p) {
    std::array<double, 100> lobe{};
    clamped_cosine_lobe(transfer.layout.order, {0, 1, 0}, lobe);
    for (std::size_t i = 0; i < transfer.dimension(); ++i)
        EXPECT_NEAR(static_cast<double>(transfer.vector(p)[i]), lobe[i], 1e-6) << p << " " << i;
}

TEST(HardCase, OneTriangleIsOpen) {
    const Transfer t = bake_scene(SceneBuilder().triangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}).build());
    for (std::size_t p = 0; p < 3; ++p)
        expect_open(t, p);
}

TEST(HardCase, DegenerateDuplicatedAndNeedleTrianglesDoNoHarm) {
    SceneBuilder builder;
    builder.floor({0, 0, 0}, 1, 3);
    builder.floor({0, 0, 0}, 1, 3);                              // duplicated
    builder.triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});           // a point
    builder.triangle({0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0});     // a line
    builder.triangle({-1, 0, 0}, {1, 0, 1e-7f}, {1, 0, 0});      // a needle
    builder.triangle({0, 0, 0}, {1e-30f, 0, 0}, {0, 0, 1e-30f}); // no area
    const Transfer t = bake_scene(builder.build());
    expect_finite(t);
    for (std::size_t p = 0; p < 2 * 9 * 6; ++p) // both floors lie open, one in the other
        expect_open(t, p);
}

/// A triangle without area is on a floor. Two of its corners are at corners of the floor and take their
/// light; the third is at no other vertex and stays black.
TEST(HardCase, VerticesWithoutAreaGetTheLightOfTheirPosition) {
    for (const FitMode fit : {FitMode::vertex, FitMode::surface}) {
        BakeOptions options;
        options.order = 3;
        options.rays = 64;
        options.fit = fit;
        Scene scene = SceneBuilder().floor({0, 0, 0}, 1).triangle({-1, 0, -1}, {0, 0, 0}, {1, 0, 1}).build();
        for (glm::vec3& normal : scene.vertex_arrays[0].normals)
            normal = {0, 1, 0};
        const Transfer t = bake(scene, options).baked.transfer;
        const std::size_t first = t.receivers() - 3;
        EXPECT_NEAR(t.vector(first)[0], t.vector(0)[0], 1e-5f);
        EXPECT_GT(t.vector(first)[0], 0.2f);
        EXPECT_EQ(t.vector(first + 1)[0], 0); // no vertex in the middle of the floor
        EXPECT_GT(t.vector(first + 2)[0], 0.2f);
    }
}

class Magnitude : public testing::TestWithParam<std::pair<float, float>> {};
INSTANTIATE_TEST_SUITE_P(Scales, Magnitude,
                         testing::Values(std::pair{1e-6f, 0.0f}, std::pair{1e-3f, 0.0f},
                                         std::pair{1e6f, 0.0f}, std::pair{3e8f, 0.0f}, std::pair{1e3f, 1e6f},
                                         std::pair{1.0f, 1e3f}));

TEST_P(Magnitude, ScaledAndMovedScenesHaveTheSameTransfer) {
    const auto [scale, offset] = GetParam();
    const auto builder = [] { return SceneBuilder().floor({0, 0, 0}, 3, 4).sphere({0, 1, 0}, 0.5f, 12); };
    const Transfer t = bake_scene(builder().build(), 512);
    const Transfer moved = bake_scene(builder()
                                          .transform([scale = scale, offset = offset](const glm::vec3& p) {
                                              return p * scale + glm::vec3(offset, 0, -offset);
                                          })
                                          .build(),
                                      512);
    // Moved by 1000 sizes the sphere itself is rounded by 1e-4 of its size; rays through that shell may
    // change.
    const double tolerance = offset == 0 ? 1e-5 : 5e-3;
    const std::vector<float> areas = receiver_areas(builder().build());
    for (std::size_t p = 0; p < t.receivers(); ++p)
        for (std::size_t i = 0; areas[p] > 1e-6f && i < t.dimension();
             ++i) // at the poles, some areas are nonzero only by rounding
            ASSERT_NEAR(t.vector(p)[i], moved.vector(p)[i], tolerance) << p << " " << i;
}

TEST(HardCase, OpenFloorsStayOpenAtEveryDistanceFromTheOrigin) {
    for (const float where : {0.0f, 1.0f, 1e3f, 1e6f, -3e6f})
        for (const float size : {1e-2f, 1.0f, 1e4f}) {
            const Scene scene = SceneBuilder().floor({where, where, where}, size, 2).build();
            const auto areas = receiver_areas(scene);
            const Transfer t = bake_scene(scene, 128);
            for (std::size_t p = 0; p < t.receivers(); ++p)
                if (areas[p] > 0) // at 1e6 a cell of 1e-2 has no area left
                    expect_open(t, p);
        }
}

/// Returns a sphere over a floor with a total size of `size` m, at `distance` m from the middle of a world of
/// that extent.
Scene small_object_far_out(float size, float distance) {
    Scene scene = SceneBuilder()
                      .floor({0, 0, 0}, 1, 8)
                      .sphere({0, 0.3f, 0}, 0.25f, 24)
                      .transform([=](const glm::vec3& p) {
                          return p * (size / 2) + glm::vec3(distance, 0, -0.3f * distance);
                      })
                      .triangle({-distance, -1, 0}, {-distance, -1, 1}, {-distance + 1, -1, 0})
                      .build();
    scene.primitives[0].node_name = "object";
    return scene;
}

TEST(HardCase, SmallObjectsFarOutKeepTheirShadows) {
    const Transfer near = bake_scene(small_object_far_out(0.08f, 1), 256),
                   far = bake_scene(small_object_far_out(0.08f, 600), 256);
    double squared = 0, norm = 0;
    for (std::size_t p = 0; p + 3 < near.receivers(); ++p)
        for (std::size_t i = 0; i < near.dimension(); ++i) {
            const double d = static_cast<double>(far.vector(p)[i]) - static_cast<double>(near.vector(p)[i]);
            squared += d * d;
            norm += static_cast<double>(near.vector(p)[i]) * static_cast<double>(near.vector(p)[i]);
        }
    EXPECT_LT(std::sqrt(squared / norm), 0.03);
}

TEST(HardCase, ObjectsTooSmallForTheirDistanceAreReported) {
    for (const auto& [size, distance, too_small] :
         {std::tuple{0.04f, 6000.0f, true}, {0.04f, 60.0f, false}, {1.0f, 6000.0f, false}}) {
        // The far triangle is a separate object, far larger than its rounding.
        Scene scene = small_object_far_out(size, distance);
        Primitive mark = scene.primitives[0];
        mark.node_name = "mark";
        mark.triangles = {mark.triangles.back()};
        scene.primitives[0].triangles.pop_back();
        scene.primitives.push_back(std::move(mark));
        const auto notice = small_object_notice(scene);
        EXPECT_EQ(notice.has_value(), too_small) << size << " " << distance;
        if (notice) {
            EXPECT_EQ(notice->substr(0, 10), "1 object i");
            EXPECT_NE(notice->find("object has a size of 0.04 m and is 6000 m"), std::string::npos)
                << *notice;
        }
    }
}

TEST(HardCase, ALargeCoplanarFloorDoesNotBlockASmallOne) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1e5f).floor({1e-3f, 0, 2e-3f}, 0.5f, 4).build();
    const Transfer t = bake_scene(scene);
    for (std::size_t p = 0; p < t.receivers(); ++p)
        expect_open(t, p);
}

TEST(HardCase, BothSidesOfAClosedSheetSeeTheirOwnHalf) {
    const Scene scene = SceneBuilder()
                            .quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1})
                            .quad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1})
                            .build();
    const Transfer t = bake_scene(scene);
    for (std::size_t p = 0; p < 6; ++p)
        expect_open(t, p);
    std::array<double, 100> below{};
    clamped_cosine_lobe(4, {0, -1, 0}, below);
    for (std::size_t p = 6; p < 12; ++p)
        for (std::size_t i = 0; i < t.dimension(); ++i)
            EXPECT_NEAR(static_cast<double>(t.vector(p)[i]), below[i], 1e-6);
}

TEST(HardCase, ReceiversInsideOtherGeometryAreDark) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 0.3f, 2).sphere({0, 0, 0}, 1, 12).build();
    const Transfer t = bake_scene(scene);
    for (std::size_t p = 0; p < 4 * 6; ++p)
        for (const float v : t.vector(p))
            EXPECT_EQ(v, 0);
}

TEST(HardCase, ANearlyBlockedReceiverKeepsItsLastLight) {
    // A slit of 0.01 in a roof: visibility about 0.01 · 2/pi, found within a tenth.
    const Scene scene = SceneBuilder()
                            .quad({-50, 1, -50}, {-50, 1, 50}, {-0.005f, 1, 50}, {-0.005f, 1, -50})
                            .quad({0.005f, 1, -50}, {0.005f, 1, 50}, {50, 1, 50}, {50, 1, -50})
                            .build();
    const Transfer t =
        test::traced_at(TraceScene(scene), glm::vec3(0), {0, 1, 0}, {.order = 1, .rays = 1 << 16});
    // (1/pi) ∫ cos over the slit = (1/pi) ∫∫ dx dz / (1 + x² + z²)², x in ±0.005, z in ±50: 0.01/pi · pi/2,
    // plus the part beyond the roof's edge at distance 50: about (1/50)².
    EXPECT_NEAR(t.vectors[0] / 0.28209479, 0.01 / 2 + 4e-4, 5e-4);
}

TEST(HardCase, ReceiversWithoutSurfaceAreSkipped) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    scene.vertex_arrays[0].positions.emplace_back(0, 1, 0); // in no triangle
    scene.vertex_arrays[0].normals.emplace_back(0, 1, 0);
    scene.vertex_arrays[0].normals[0] = glm::vec3(0);
    BakeOptions options;
    options.rays = 64;
    const BakeResult result = bake(scene, options);
    EXPECT_EQ(result.statistics.receivers.traced, 5u);
    for (const std::size_t p : {0u, 6u})
        for (const float v : result.baked.transfer.vector(p))
            EXPECT_EQ(v, 0);
}

TEST(HardCase, FlippedNormalsLookTheOtherWay) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    for (glm::vec3& n : scene.vertex_arrays[0].normals)
        n = -n;
    const Transfer t = bake_scene(scene);
    std::array<double, 100> below{};
    clamped_cosine_lobe(4, {0, -1, 0}, below);
    for (std::size_t i = 0; i < t.dimension(); ++i)
        EXPECT_NEAR(static_cast<double>(t.vector(0)[i]), below[i], 1e-6);
}

TEST(HardCase, OrdersOneAndTenWork) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 3).sphere({0, 1, 0}, 0.5f, 8).build();
    const auto baked = [&](int order) {
        BakeOptions options;
        options.order = order;
        options.rays = 200;
        options.repairs.denoise = false; // looks at all bands
        return bake(scene, options).baked.transfer;
    };
    const Transfer low = baked(1), high = baked(10);
    expect_finite(high);
    for (std::size_t p = 0; p < low.receivers(); ++p)
        EXPECT_NEAR(low.vector(p)[0], high.vector(p)[0], 1e-6f);
}

} // namespace
} // namespace prt
