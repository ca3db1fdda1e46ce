// Tests unwrapping: every surface point gets a unique coordinate.

#include "bake/products/lightmaps/unwrap.h"

#include "bake/products/lightmaps/chart_packing.h"
#include "bake/products/lightmaps/texel_samples.h"
#include "prt/core/error.h"
#include "support/gpu_scenes.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace prt {
namespace {

using test::SceneBuilder;

/// Returns the scene with the coordinates of the unwrapping as its only set.
Scene with(const Scene& scene, const Unwrapping& unwrapping) {
    Scene result = scene;
    result.vertex_arrays.clear();
    std::size_t first = 0;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const VertexSplit& split = unwrapping.primitives[p];
        const VertexArray& from = scene.vertex_arrays[scene.primitives[p].vertices];
        VertexArray vertices;
        for (const std::uint32_t v : split.source) {
            vertices.positions.push_back(from.positions.at(v));
            vertices.normals.push_back(from.normals.at(v));
        }
        vertices.texcoords = {split.uv};
        vertices.first_receiver = first;
        first += vertices.size();
        result.primitives[p].vertices = p;
        result.primitives[p].triangles = split.triangles;
        result.vertex_arrays.push_back(std::move(vertices));
    }
    return result;
}

/// A ramp that winds up three times about an axis: seen from above it lies over itself.
Scene helix() {
    SceneBuilder builder;
    constexpr int kSteps = 96;
    const auto at = [](int i, float radius) {
        const float angle = static_cast<float>(i) / 32 * 6.2831853f;
        return glm::vec3(radius * std::cos(angle), 0.02f * static_cast<float>(i), -radius * std::sin(angle));
    };
    for (int i = 0; i < kSteps; ++i)
        builder.quad(at(i, 1), at(i, 2), at(i + 1, 2), at(i + 1, 1));
    Scene scene = builder.build();
    // One sheet: adjacent triangles have equal normals where they touch.
    for (glm::vec3& n : scene.vertex_arrays[0].normals)
        n = {0, 1, 0};
    return scene;
}

Scene crumpled(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0, 0.15f);
    return SceneBuilder()
        .sphere({0, 0, 0}, 1, 10)
        .transform(
            [&](const glm::vec3& p) { return p + glm::vec3(noise(random), noise(random), noise(random)); })
        .build();
}

/// A floor, and triangles of one place or one line at its corners and elsewhere.
TEST(Unwrap, FacesWithoutAreaHaveNoCharts) {
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 1, 4).build();
    const TexelOptions options{.size = 64};
    Scene scene = floor;
    VertexArray& vertices = scene.vertex_arrays[0];
    for (const glm::vec3& position : {vertices.positions[0], glm::vec3(7, 8, 9)})
        for (int i = 0; i < 3; ++i) {
            vertices.positions.push_back(position + (i == 2 ? glm::vec3(100, 0, 0) : glm::vec3(0)));
            vertices.normals.emplace_back(0);
        }
    const auto last = static_cast<unsigned>(vertices.size());
    scene.primitives[0].triangles.insert(scene.primitives[0].triangles.begin(),
                                         {{last - 6, last - 5, last - 4}, {last - 3, last - 2, last - 1}});
    const Unwrapping plain = unwrap(floor, options), unwrapping = unwrap(scene, options);
    EXPECT_EQ(plain.charts, 1u);
    EXPECT_EQ(unwrapping.charts, 1u);
    EXPECT_EQ(unwrapping.texels_per_metre, plain.texels_per_metre);
    for (const glm::vec2& uv : unwrapping.primitives[0].uv)
        EXPECT_TRUE(uv.x > 0 && uv.x < 1 && uv.y > 0 && uv.y < 1) << uv.x << ' ' << uv.y;
}

TEST(Unwrap, SmallSizesAreRejectedWithASufficientOne) {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 1).build();
    VertexArray& vertices = scene.vertex_arrays[0];
    const std::vector<glm::vec3> positions = vertices.positions;
    const std::vector<glm::vec3> normals = vertices.normals;
    const std::vector<glm::uvec3> triangles = scene.primitives[0].triangles;
    for (unsigned copy = 1; copy < 300; ++copy) {
        for (const glm::vec3& p : positions)
            vertices.positions.push_back(p + glm::vec3(0, copy, 0));
        vertices.normals.insert(vertices.normals.end(), normals.begin(), normals.end());
        for (const glm::uvec3& t : triangles)
            scene.primitives[0].triangles.push_back(t + copy * static_cast<unsigned>(positions.size()));
    }
    try {
        unwrap(scene, {.size = 32});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("too small for at least 300 charts; use 256 or more"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_EQ(unwrap(scene, {.size = 256}).charts, 300u);
}

class Unwrapped : public testing::TestWithParam<int> {
protected:
    static Scene scene() {
        switch (GetParam()) {
        case 0:
            return SceneBuilder().floor({0, 0, 0}, 1, 4).build();
        case 1:
            return SceneBuilder().sphere({3, 2, 1}, 0.7f, 16).build();
        case 2:
            return helix();
        case 3:
            return test::degenerate_triangles(1);
        case 4:
            return crumpled(2);
        default:
            return test::join({test::copies_over_floor(3, true), helix()});
        }
    }
};
INSTANTIATE_TEST_SUITE_P(Scenes, Unwrapped, testing::Range(0, 6));

TEST_P(Unwrapped, SurfacesHaveSeparatePositions) {
    const Scene before = scene();
    constexpr int kSize = 512;
    const Unwrapping unwrapping = unwrap(before, {.size = kSize});
    const Scene after = with(before, unwrapping);
    Atlas atlas = plan_atlases(after, {.size = kSize, .uv_set = 0, .atlases = AtlasMode::one}).front();
    const std::vector<ChartTriangle> charts = chart_triangles(after, atlas);
    EXPECT_EQ(sample_texels(charts, atlas).overlapping, 0);
    for (const VertexArray& vertices : after.vertex_arrays)
        for (const glm::vec2& uv : vertices.texcoords[0]) { // at least two texels from the border
            EXPECT_GE(std::min(uv.x, uv.y), 2.0f / kSize);
            EXPECT_LE(std::max(uv.x, uv.y), 1 - 2.0f / kSize);
        }
    // Triangles are unchanged, and projections shrink none to less than 0.3.
    const double density = unwrapping.texels_per_metre * unwrapping.texels_per_metre;
    std::size_t chart = 0;
    for (std::size_t p = 0; p < before.primitives.size(); ++p) {
        const auto& old = before.vertex_arrays[before.primitives[p].vertices].positions;
        const auto& now = after.vertex_arrays[p].positions;
        for (std::size_t t = 0; t < before.primitives[p].triangles.size(); ++t, ++chart) {
            const glm::uvec3 &a = before.primitives[p].triangles[t], &b = after.primitives[p].triangles[t];
            for (int i = 0; i < 3; ++i)
                EXPECT_EQ(old[a[i]], now[b[i]]);
            const double area =
                static_cast<double>(glm::length(glm::cross(old[a.y] - old[a.x], old[a.z] - old[a.x])));
            const glm::dvec2 u = charts[chart].corners[1] - charts[chart].corners[0],
                             v = charts[chart].corners[2] - charts[chart].corners[0];
            // Coordinates are floats: 512 * 2^-25 texels at both ends of edges of 100 texels.
            EXPECT_LE(std::abs(u.x * v.y - u.y * v.x), 1.001 * area * density + 3e-3);
            EXPECT_GE(std::abs(u.x * v.y - u.y * v.x), 0.29 * area * density - 1e-2);
        }
    }
}

TEST(Unwrap, TexturesHaveTheRequestedDensity) {
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 1, 4).build();
    const Unwrapping unwrapping = unwrap(floor, {.per_metre = 32});
    EXPECT_EQ(unwrapping.charts, 1u);
    EXPECT_DOUBLE_EQ(unwrapping.texels_per_metre, 32);
    EXPECT_GE(unwrapping.atlases.at(0).width, 64 + 5);
    EXPECT_LE(unwrapping.atlases[0].width, 80);
    EXPECT_EQ(unwrapping.primitives[0].source.size(), floor.vertex_arrays[0].size()); // no vertex is split
    EXPECT_THROW(unwrap(floor, {.per_metre = 1e5}), Error);
    EXPECT_THROW(unwrap(crumpled(1), {.size = 8}), Error);
}

TEST(Unwrap, EachObjectGetsATextureOfItsSize) {
    Scene scene = test::join(
        {SceneBuilder().floor({0, 0, 0}, 8).build(), SceneBuilder().floor({0, 1, 0}, 0.25f).build()});
    scene.primitives[1].node = 1;
    const Unwrapping unwrapping = unwrap(scene, {.per_metre = 8, .atlases = AtlasMode::each});
    ASSERT_EQ(unwrapping.atlases.size(), 2u);
    EXPECT_GE(unwrapping.atlases[0].width, 128);
    EXPECT_LE(unwrapping.atlases[1].width, 16);
}

TEST(Unwrap, PacksRectanglesWithoutOverlap) {
    std::mt19937 random(1);
    std::vector<glm::ivec2> sizes;
    for (int i = 0; i < 60; ++i)
        sizes.emplace_back(1 + random() % 20, 1 + random() % 20);
    const auto corners = pack_rectangles(sizes, 128);
    ASSERT_TRUE(corners);
    std::vector<int> owner(128 * 128, -1);
    for (std::size_t r = 0; r < sizes.size(); ++r)
        for (int y = (*corners)[r].y; y < (*corners)[r].y + sizes[r].y; ++y)
            for (int x = (*corners)[r].x; x < (*corners)[r].x + sizes[r].x; ++x) {
                ASSERT_LT(std::max(x, y), 128);
                EXPECT_EQ(owner[static_cast<std::size_t>(128 * y + x)], -1);
                owner[static_cast<std::size_t>(128 * y + x)] = static_cast<int>(r);
            }
    EXPECT_FALSE(pack_rectangles(sizes, 40));
    EXPECT_FALSE(pack_rectangles(std::vector<glm::ivec2>{{50, 1}}, 40));
}

} // namespace
} // namespace prt
