// Tests that fitted light stays within physical bounds: uniform light 1 results in 0..1, closed rooms are
// dark, white furnaces are 1.

#include "bake/surface_fit/value_limits.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/transfer.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace prt {
namespace {

using test::SceneBuilder;

struct Range {
    float low = 1e9f, high = -1e9f;
};

Range range_of(const std::vector<glm::vec3>& values, std::size_t first, std::size_t end) {
    Range range;
    for (std::size_t p = first; p < end; ++p)
        for (int c = 0; c < 3; ++c) {
            range.low = std::min(range.low, values[p][c]);
            range.high = std::max(range.high, values[p][c]);
        }
    return range;
}

std::vector<glm::vec3> under_uniform_light(const Scene& scene, const BakeOptions& options) {
    const Transfer transfer = bake(scene, options).baked.transfer;
    return exit_radiance(transfer, constant_light(transfer.layout.order, glm::vec3(1)));
}

BakeOptions options_of(int bounces, FitMode fit, int rays = 128) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.bounces = bounces;
    options.fit = fit;
    return options;
}

/// Random points in the cube -1..1.
class RandomPoints {
public:
    explicit RandomPoints(unsigned seed) : random_(seed) {}
    glm::vec3 operator()() { return {unit_(random_), unit_(random_), unit_(random_)}; }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> unit_{-1, 1};
};

/// White two-sided triangles, long and thin, in a heap.
Scene needles(int count) {
    RandomPoints point(7);
    SceneBuilder builder;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 middle = point(), along = glm::normalize(point());
        builder.triangle(middle - along, middle + along, middle + 0.01f * point());
    }
    return test::painted(builder.build(), glm::vec3(1), true);
}

/// White two-sided sheets that cross each other.
Scene sheets(int count) {
    RandomPoints point(3);
    SceneBuilder builder;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 a = point(), b = 0.6f * point(), d = 0.6f * point();
        builder.quad(a, a + b, a + b + d, a + d);
    }
    return test::painted(builder.build(), glm::vec3(1), true);
}

TEST(BoundedFit, UniformLightStaysBetweenZeroAndOne) {
    for (const Scene& scene : {needles(300), sheets(40)})
        for (const int bounces : {0, 2, 8}) {
            const std::vector<glm::vec3> lit =
                under_uniform_light(scene, options_of(bounces, FitMode::surface));
            const Range range = range_of(lit, 0, lit.size());
            EXPECT_GE(range.low, -1e-3f) << bounces;
            EXPECT_LE(range.high, 1.001f) << bounces;
        }
}

TEST(BoundedFit, WhiteFurnaceKeepsAllLight) {
    const Scene bowl = test::painted(SceneBuilder().bowl({0, 0, 0}, 1, 8, 3).build(), glm::vec3(1), true);
    for (const Scene& scene : {needles(200), sheets(30), bowl}) {
        const std::vector<glm::vec3> lit =
            under_uniform_light(scene, options_of(kEndlessBounces, FitMode::surface));
        const std::vector<float> areas = receiver_areas(scene);
        for (std::size_t p = 0; p < lit.size(); ++p) {
            const float expected = areas[p] > 0 ? 1 : 0; // at the pole of the bowl are triangles without area
            EXPECT_NEAR(lit[p].x, expected, 1e-3f);
        }
    }
}

/// Adds a rectangle of cells from `a` to `a + x + z`.
void add_cells(SceneBuilder& builder, const glm::vec3& a, const glm::vec3& x, const glm::vec3& z, int nx,
               int nz) {
    for (int i = 0; i < nx; ++i)
        for (int k = 0; k < nz; ++k) {
            const auto at = [&](int s, int t) {
                return a + x * (static_cast<float>(s) / static_cast<float>(nx)) +
                       z * (static_cast<float>(t) / static_cast<float>(nz));
            };
            builder.quad(at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
        }
}

/// Returns the inside of a closed cube of 2 m with its floor at y = 0.
Scene dark_room() {
    SceneBuilder builder;
    constexpr int kCells = 4;
    const glm::vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), low(-1, 0, -1);
    add_cells(builder, low, x, z, kCells, kCells);     // floor
    add_cells(builder, low + y, z, x, kCells, kCells); // ceiling
    add_cells(builder, low, z, y, kCells, kCells);     // -x
    add_cells(builder, low + x, y, z, kCells, kCells); // +x
    add_cells(builder, low, y, x, kCells, kCells);     // -z
    add_cells(builder, low + z, x, y, kCells, kCells); // +z
    return builder.build();
}

/// Returns its outer faces and the ground around it, with cells that match those inside.
Scene ground_and_outside() {
    SceneBuilder builder;
    constexpr int kCells = 4;
    const glm::vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), low(-1, 0, -1);
    add_cells(builder, low + y, x, z, kCells, kCells);
    add_cells(builder, low, y, z, kCells, kCells);
    add_cells(builder, low + x, z, y, kCells, kCells);
    add_cells(builder, low, x, y, kCells, kCells);
    add_cells(builder, low + z, y, x, kCells, kCells);
    for (int i = -1; i <= 1; ++i)
        for (int k = -1; k <= 1; ++k)
            if (i != 0 || k != 0)
                add_cells(builder, low + static_cast<float>(i) * x + static_cast<float>(k) * z, x, z, kCells,
                          kCells);
    return builder.build();
}

/// Tests that the floor of the room and the ground around it do not exchange light, in one node or in two.
TEST(BoundedFit, DarkRoomsStayDarkNextToGroundOfEqualHeight) {
    Scene scene = test::join({dark_room(), ground_and_outside()});
    const std::size_t inside = scene.vertex_arrays[0].size();
    for (const bool one_node : {false, true}) {
        if (one_node) { // two-sided, since rays that meet two faces at once may count the back of one
            scene = test::painted(std::move(scene), glm::vec3(1), true);
            for (Primitive& primitive : scene.primitives)
                primitive.node = 0;
        }
        for (const int rays : {16, 128, 512}) {
            const std::vector<glm::vec3> lit =
                under_uniform_light(scene, options_of(0, FitMode::surface, rays));
            EXPECT_EQ(range_of(lit, 0, inside).high, 0) << one_node << ' ' << rays;
            const Range outside = range_of(lit, inside, lit.size());
            EXPECT_GE(outside.low, rays < 128 ? 0.4f : 0.47f) << one_node << ' ' << rays;
            EXPECT_LE(outside.high, 1.001f);
        }
    }
}

/// Returns a box whose lower vertices are hidden in a floor of two triangles.
Scene box_in_floor() {
    Scene box = test::painted(SceneBuilder().sphere({0, 0, 0}, 0.5f, 2).build(), glm::vec3(0.8f));
    for (glm::vec3& p : box.vertex_arrays[0].positions)
        p.y += 0.43f;
    Scene scene =
        test::join({test::painted(SceneBuilder().floor({0, 0, 0}, 3).build(), glm::vec3(0.8f)), box});
    PunctualLight sun;
    sun.name = "Sun";
    sun.kind = PunctualKind::directional;
    sun.direction = glm::normalize(glm::vec3(0.4f, -1, 0.3f));
    scene.lights = {sun};
    return scene;
}

TEST(BoundedFit, LampLightIsNonnegative) {
    const Scene scene = box_in_floor();
    for (const int bounces : {0, 1, 4, kEndlessBounces}) {
        const Transfer transfer = bake(scene, options_of(bounces, FitMode::surface, 64)).baked.transfer;
        const std::size_t sky = transfer.layout.dimension() - 1; // the lamp is white, and the last
        ASSERT_EQ(transfer.layout.lamp_terms().size(), 1u);
        for (std::size_t p = 0; p < transfer.receivers(); ++p) {
            EXPECT_GE(transfer.vector(p)[sky], -1e-6f) << bounces;
            EXPECT_LE(transfer.vector(p)[sky], 1.0f) << bounces; // 1/pi plus the reflected part
        }
    }
}

TEST(BoundedFit, LimitsRemoveOnlyExcessLight) {
    const TestValues tests = TestValues::of_lamps(2, 1, 4);
    ASSERT_EQ(tests.count(), 2u);
    // Two unknowns of samples in 0..1 (first lamp) and 5..6 (second).
    const ValueRanges ranges{{0, 5, 0, 5}, {1, 6, 1, 6}};
    const std::vector<float> smooth{0.5f, 5.5f, 0, 0, 0.5f, 5.5f, 0, 0},
        sharp{1.5f, 5.9f, 0, 0, 0.9f, 4.5f, 0, 0};
    std::vector<float> shares(4, 1);
    limit_shares(tests, ranges, smooth, sharp, shares);
    EXPECT_NEAR(shares[0], 0.5f, 1e-3f);
    EXPECT_EQ(shares[1], 1);
    EXPECT_EQ(shares[2], 1);
    EXPECT_NEAR(shares[3], 0.5f, 2e-3f);
}

} // namespace
} // namespace prt
