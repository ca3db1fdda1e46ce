// Tests texels as receivers: their positions, gutters between charts, and seams.

#include "bake/products/lightmaps/gutters.h"
#include "bake/products/lightmaps/seams.h"
#include "bake/products/lightmaps/texel_samples.h"
#include "bake/products/lightmaps/unwrap.h"
#include "prt/bake/ambient_occlusion.h"
#include "prt/core/error.h"
#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace prt {
namespace {

using test::SceneBuilder;

/// Returns `scene` with coordinates `position(position)`.
Scene mapped(Scene scene, const std::function<glm::vec2(const glm::vec3&)>& position) {
    for (VertexArray& vertices : scene.vertex_arrays) {
        vertices.texcoords.assign(1, {});
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords[0].push_back(position(p));
    }
    return scene;
}

/// A floor of two metres that fills `size` of the texture from `corner` on.
Scene floor_at(const glm::vec2& corner, float size, int cells = 1) {
    return mapped(SceneBuilder().floor({0, 0, 0}, 1, cells).build(),
                  [&](const glm::vec3& p) { return corner + size * (glm::vec2(p.x, p.z) + 1.0f) / 2.0f; });
}

Atlas atlas_of(const Scene& scene, int size) {
    return plan_atlases(scene, {.size = size, .uv_set = 0}).front();
}

/// Returns an atlas of the first primitive, without planning.
Atlas first_primitive(int size) {
    Atlas atlas;
    atlas.primitives = {0};
    atlas.uv_set = 0;
    atlas.width = atlas.height = size;
    return atlas;
}

std::vector<TexelSample> samples_of(const Scene& scene, const Atlas& atlas) {
    return sample_texels(chart_triangles(scene, atlas), atlas).samples;
}

/// Position of a sample.
glm::vec3 position_of_sample(const Scene& scene, const TexelSample& sample) {
    const glm::uvec3& t = scene.primitives[0].triangles[sample.triangle];
    const auto& p = scene.vertex_arrays[0].positions;
    return p[t.x] * (1 - sample.uv.x - sample.uv.y) + p[t.y] * sample.uv.x + p[t.z] * sample.uv.y;
}

TEST(Texels, FollowTheirCoordinates) {
    const Scene scene = floor_at({0, 0}, 1);
    const Atlas atlas = atlas_of(scene, 8);
    const std::vector<TexelSample> samples = samples_of(scene, atlas);
    EXPECT_EQ(samples.size(), 8 * 8 * kSamplesOfTexel);
    for (const TexelSample& sample : samples) {
        const glm::vec3 p = position_of_sample(scene, sample);
        EXPECT_EQ(static_cast<int>((p.x + 1) / 2 * 8), static_cast<int>(sample.texel % 8));
        EXPECT_EQ(static_cast<int>((p.z + 1) / 2 * 8), static_cast<int>(sample.texel / 8));
    }
}

TEST(Texels, TouchedByAChartHaveAPositionOnIt) {
    // Shapes smaller than the spacing of points in a texel, thinner than a texel, a line, a point; at the
    // border.
    const struct {
        glm::vec2 corner, size;
        std::size_t texels;
    } cases[] = {{{0.51f, 0.51f}, {0.01f, 0.01f}, 1},
                 {{0.02f, 0.3f}, {0.9f, 0.005f}, 8},
                 {{0.3f, 0.3f}, {0, 0}, 1},
                 {{0, 0}, {1e-3f, 1}, 8},
                 {{0.999f, 0.999f}, {1e-3f, 1e-3f}, 1}};
    for (const auto& c : cases) {
        const Scene scene = mapped(SceneBuilder().floor({0, 0, 0}, 1).build(), [&](const glm::vec3& p) {
            return c.corner + c.size * (glm::vec2(p.x, p.z) + 1.0f) / 2.0f;
        });
        const Atlas atlas = first_primitive(8); // for coordinates that planning rejects, too
        std::set<std::uint32_t> texels;
        for (const TexelSample& sample : samples_of(scene, atlas)) {
            texels.insert(sample.texel);
            const glm::vec3 p = position_of_sample(scene, sample);
            EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1.0001f);
        }
        EXPECT_EQ(texels.size(), c.texels) << c.corner.x << " " << c.size.x;
    }
}

TEST(Texels, IncludeMirroredChartsAndOtherTiles) {
    const Scene mirrored = mapped(SceneBuilder().floor({0, 0, 0}, 1).build(), [](const glm::vec3& p) {
        return glm::vec2(1 - p.x, p.z + 1) / 2.0f + glm::vec2(3, -2);
    });
    const Atlas atlas = atlas_of(mirrored, 4);
    EXPECT_TRUE(atlas.repeats);
    EXPECT_EQ(samples_of(mirrored, atlas).size(), 16 * kSamplesOfTexel);
    EXPECT_FALSE(atlas_of(floor_at({0, 0}, 1), 4).repeats);
}

TEST(Texels, InvalidCoordinatesAreRejected) {
    const auto refused = [](const Scene& scene, const TexelOptions& options, const std::string& why) {
        try {
            plan_atlases(scene, options);
            ADD_FAILURE() << why;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    const Scene good = floor_at({0, 0}, 1);
    refused(good, {.size = 8, .uv_set = 1}, "has no TEXCOORD_1");
    refused(floor_at({0.5f, 0}, 1), {.size = 8, .uv_set = 0}, "crosses the border");
    for (const TexelOptions& options : {TexelOptions{.per_metre = 8, .uv_set = 0}, {.size = 8, .uv_set = 0}})
        refused(floor_at({0.5f, 0.5f}, 0), options, "covers no area");
    // Two layers of triangles far smaller than a texel.
    const Scene fine = floor_at({0, 0}, 1, 200);
    refused(test::join({fine, fine}), {.size = 8, .uv_set = 0, .atlases = AtlasMode::one},
            "is covered more than once");
    refused(good, {.per_metre = 1e5, .uv_set = 0}, "more than the limit of 8192");
    refused(good, {.per_metre = 0, .uv_set = 0}, "finite and greater than 0");
    Scene twice = test::join({good, good});
    twice.primitives[1].node = twice.primitives[0].node;
    refused(twice, {.size = 8, .uv_set = 0, .atlases = AtlasMode::one}, "100.0 %");
    refused(twice, {.size = 8, .uv_set = 0}, "overlap");
}

TEST(Texels, OverlappingObjectsHaveSeparateTextures) {
    Scene twice = test::join({floor_at({0, 0}, 1), floor_at({0, 0}, 1)});
    twice.primitives[1].node = 1;
    EXPECT_EQ(plan_atlases(twice, {.size = 8, .uv_set = 0}).size(), 2u);
    Scene beside = test::join({floor_at({0, 0}, 0.5f), floor_at({0.5f, 0.5f}, 0.5f)});
    beside.primitives[1].node = 1;
    EXPECT_EQ(plan_atlases(beside, {.size = 8, .uv_set = 0}).size(), 1u);
    // Half of the texture along each side for two metres: 64 texels are 16 a metre.
    EXPECT_EQ(plan_atlases(beside, {.per_metre = 16, .uv_set = 0}).front().width, 64);
}

TEST(Texels, NeedlesHaveFewTexels) {
    // Lines from corner to corner: only the texels they touch are visited.
    const Scene scene = mapped(SceneBuilder().floor({0, 0, 0}, 1, 30).build(),
                               [](const glm::vec3& p) { return glm::vec2(0.5f + 0.45f * p.x); });
    const Atlas atlas = first_primitive(256);
    const TexelSamples samples = sample_texels(chart_triangles(scene, atlas), atlas);
    EXPECT_GE(samples.samples.size(), 230u);
    EXPECT_LE(samples.samples.size(), 3u * 256);
    EXPECT_TRUE(seam_points(scene, atlas).empty());
}

TEST(Gutters, WrapInRepeatingTextures) {
    Atlas atlas;
    atlas.width = atlas.height = 9;
    atlas.repeats = true;
    std::vector<float> values(atlas.texels());
    std::vector<bool> filled(atlas.texels());
    filled[0] = filled[40] = true; // a corner, and the middle
    values[0] = 1;
    fill_gutters(atlas, filled, values, 1);
    EXPECT_EQ(values[80], 1); // the corner across
    EXPECT_EQ(values[8], 1);
    EXPECT_EQ(bilinear_at(atlas, {0, 4.5}).texels[0] % 9, 8u);
}

TEST(Gutters, CopyTheNearestTexel) {
    Atlas atlas;
    atlas.width = 9;
    atlas.height = 7;
    std::vector<float> values(atlas.texels() * 2, -1);
    std::vector<bool> filled(atlas.texels());
    const auto fill = [&](std::size_t texel, float value) {
        filled[texel] = true;
        values[2 * texel] = value;
        values[2 * texel + 1] = 10 * value;
    };
    fill(0, 1);
    fill(62, 3);
    fill_gutters(atlas, filled, values, 2);
    EXPECT_EQ(values[0], 1);
    EXPECT_EQ(values[2 * 10], 1); // next to the first
    EXPECT_EQ(values[2 * 52 + 1], 30);
    for (std::size_t t = 0; t < atlas.texels(); ++t) {
        EXPECT_GE(values[2 * t], 1) << t;
        EXPECT_LE(values[2 * t], 3) << t;
        EXPECT_NEAR(values[2 * t + 1], 10 * values[2 * t], 1e-4);
    }
    fill_gutters(atlas, std::vector<bool>(atlas.texels()), values, 2); // there is no source to fill from
}

/// Returns two halves of a floor in separate charts, one of them rotated.
Scene cut_floor() {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 8).build();
    VertexArray& vertices = scene.vertex_arrays[0];
    Primitive& primitive = scene.primitives[0];
    vertices.texcoords.assign(1, std::vector<glm::vec2>(vertices.size()));
    const auto left = [](const glm::vec3& p) {
        return glm::vec2(0.03f + 0.2f * (p.x + 1), 0.03f + 0.2f * (p.z + 1));
    };
    const auto right = [](const glm::vec3& p) {
        return glm::vec2(0.53f + 0.2f * (p.z + 1), 0.97f - 0.2f * p.x);
    };
    std::map<std::uint32_t, std::uint32_t> copies;
    for (glm::uvec3& t : primitive.triangles) {
        const float middle =
            (vertices.positions[t.x].x + vertices.positions[t.y].x + vertices.positions[t.z].x) / 3;
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 p = vertices.positions[t[i]];
            if (middle < 0) {
                vertices.texcoords[0][t[i]] = left(p);
                continue;
            }
            const auto [found, is_new] =
                copies.try_emplace(t[i], static_cast<std::uint32_t>(vertices.positions.size()));
            if (is_new) {
                vertices.positions.push_back(p);
                vertices.normals.push_back(vertices.normals[t[i]]);
                vertices.texcoords[0].push_back(right(p));
            }
            t[i] = found->second;
        }
    }
    return scene;
}

double jump(const Atlas& atlas, const SeamPoint& point, std::span<const float> values) {
    double sum = 0;
    for (const auto& [position, sign] : {std::pair(point.here, 1.0), std::pair(point.there, -1.0)}) {
        const BilinearTexels filter = bilinear_at(atlas, position);
        for (std::size_t i = 0; i < 4; ++i)
            sum += sign * filter.weights[i] * static_cast<double>(values[filter.texels[i]]);
    }
    return std::abs(sum);
}

TEST(Seams, ClosingChangesOnlySeams) {
    const Scene scene = cut_floor();
    const Atlas atlas = atlas_of(scene, 64);
    const std::vector<SeamPoint> seams = seam_points(scene, atlas);
    ASSERT_GE(seams.size(), 50u); // two a texel
    std::vector<bool> measured(atlas.texels());
    std::vector<float> values(atlas.texels());
    for (const TexelSample& sample : samples_of(scene, atlas)) {
        const glm::vec3 p = position_of_sample(scene, sample);
        measured[sample.texel] = true;
        values[sample.texel] = 0.5f + 0.3f * std::sin(7 * p.x) * std::cos(5 * p.z) + (p.x > 0 ? 0.1f : 0.0f);
    }
    fill_gutters(atlas, measured, values, 1);
    const std::vector<float> before = values;
    stitch_seams(atlas, seams, measured, values, 1);
    double largest = 0, moved = 0, squared = 0;
    for (const SeamPoint& point : seams)
        largest = std::max(largest, jump(atlas, point, values));
    for (std::size_t t = 0; t < values.size(); ++t)
        if (measured[t]) {
            const double change = std::abs(static_cast<double>(values[t] - before[t]));
            moved = std::max(moved, change);
            squared += change * change;
        }
    EXPECT_LT(largest, 0.5 / 255);
    EXPECT_LT(moved, 0.12);
    EXPECT_LT(std::sqrt(squared / static_cast<double>(std::ranges::count(measured, true))), 0.03);
}

TEST(Seams, AreNotClosedAcrossFlattenedCharts) {
    // A ball over a plane in charts of a few texels each: truth is (1 + n.y) / 2.
    Scene scene = SceneBuilder().sphere({0, 0, 0}, 1, 12).build();
    const Unwrapping unwrapping = unwrap(scene, {.size = 26});
    const VertexSplit& split = unwrapping.primitives[0];
    VertexArray& vertices = scene.vertex_arrays[0];
    std::vector<glm::vec3> positions, normals;
    for (const std::uint32_t v : split.source) {
        positions.push_back(vertices.positions[v]);
        normals.push_back(vertices.normals[v]);
    }
    vertices.positions = positions;
    vertices.normals = normals;
    vertices.texcoords = {split.uv};
    scene.primitives[0].triangles = split.triangles;
    Atlas atlas = unwrapping.atlases.front();
    atlas.uv_set = 0;
    std::vector<bool> measured(atlas.texels());
    std::vector<float> truth(atlas.texels());
    for (const TexelSample& sample : samples_of(scene, atlas)) {
        measured[sample.texel] = true;
        truth[sample.texel] = 0.5f + 0.5f * position_of_sample(scene, sample).y;
    }
    std::vector<float> values = truth;
    fill_gutters(atlas, measured, values, 1);
    stitch_seams(atlas, seam_points(scene, atlas), measured, values, 1);
    double error = 0;
    for (std::size_t t = 0; t < values.size(); ++t)
        if (measured[t])
            error += std::abs(static_cast<double>(values[t] - truth[t]));
    EXPECT_LT(error / static_cast<double>(std::ranges::count(measured, true)), 0.06);
}

TEST(Seams, EndAtDifferentNormals) {
    // A floor and a wall that share an edge: light differs there.
    Scene scene = SceneBuilder()
                      .quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1})
                      .quad({-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1})
                      .build();
    VertexArray& vertices = scene.vertex_arrays[0];
    vertices.texcoords.assign(1, {});
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const glm::vec3& p = vertices.positions[v];
        vertices.texcoords[0].push_back(vertices.normals[v].y > 0.5f ? glm::vec2(p.x + 1, p.z + 4) / 6.0f
                                                                     : glm::vec2(p.x + 1, p.y) / 6.0f);
    }
    EXPECT_TRUE(seam_points(scene, atlas_of(scene, 64)).empty());
}

OcclusionMap map_of(const Scene& scene, const Atlas& atlas, const OcclusionOptions& options,
                    const FinerModel& finer = {}) {
    OcclusionMap found;
    occlusion_maps(
        scene, {atlas}, options, [&](OcclusionMap map) { found = std::move(map); }, finer);
    return found;
}

TEST(OcclusionMaps, ConvergeToPointOcclusion) {
    const Scene disc = SceneBuilder().disc({0, 0.6f, 0}, {0, -1, 0}, 0.8f, 256).build();
    Scene scene = test::join({floor_at({0, 0}, 1, 4), disc});
    scene.vertex_arrays[1].texcoords.assign(1, std::vector<glm::vec2>(scene.vertex_arrays[1].size()));
    scene.primitives[1].node = 1;
    OcclusionOptions options;
    options.rays = 4096;
    const double expected = 1 - 0.64 / (0.64 + 0.36); // the form factor of the disc, on its axis
    double error = 1;
    for (const int size : {5, 21}) { // odd: a texel lies about the middle
        const Atlas atlas = first_primitive(size);
        const OcclusionMap map = map_of(scene, atlas, options);
        EXPECT_EQ(map.measured, atlas.texels());
        EXPECT_EQ(map.sealed, 0u);
        const std::size_t middle = atlas.texels() / 2;
        const double now = std::abs(static_cast<double>(map.ambient_visibility.ambient[middle]) - expected);
        EXPECT_LT(now, error);
        error = now;
        EXPECT_NEAR(map.ambient_visibility.bent_normals[middle].y, 1, 0.01);
        // Symmetric, and more open at the border, to where light leans outwards.
        EXPECT_GT(map.ambient_visibility.ambient[0], map.ambient_visibility.ambient[middle] + 0.2f);
        EXPECT_LT(map.ambient_visibility.bent_normals[0].x, -0.05f);
    }
    EXPECT_LT(error, 0.01);
}

TEST(OcclusionMaps, HaveTheOcclusionOfAHighPolyModel) {
    // A plate for a floor with a pit in the middle, elsewhere in the file's world.
    const Scene plate = floor_at({0, 0}, 1);
    Scene fine =
        SceneBuilder()
            .quad({-1, 0, -1}, {-1, 0, 1}, {-0.5f, 0, 1}, {-0.5f, 0, -1})
            .quad({0.5f, 0, -1}, {0.5f, 0, 1}, {1, 0, 1}, {1, 0, -1})
            .quad({-0.5f, 0, -1}, {-0.5f, 0, -0.5f}, {0.5f, 0, -0.5f}, {0.5f, 0, -1})
            .quad({-0.5f, 0, 0.5f}, {-0.5f, 0, 1}, {0.5f, 0, 1}, {0.5f, 0, 0.5f})
            .quad({-0.5f, -0.2f, -0.5f}, {-0.5f, -0.2f, 0.5f}, {0.5f, -0.2f, 0.5f}, {0.5f, -0.2f, -0.5f})
            .quad({-0.5f, -0.2f, -0.5f}, {0.5f, -0.2f, -0.5f}, {0.5f, 0, -0.5f}, {-0.5f, 0, -0.5f})
            .quad({0.5f, -0.2f, 0.5f}, {-0.5f, -0.2f, 0.5f}, {-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f})
            .quad({0.5f, -0.2f, -0.5f}, {0.5f, -0.2f, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f})
            .quad({-0.5f, -0.2f, 0.5f}, {-0.5f, -0.2f, -0.5f}, {-0.5f, 0, -0.5f}, {-0.5f, 0, 0.5f})
            .build();
    fine.origin = {0, 5, 0}; // both are at one position in the world
    for (glm::vec3& p : fine.vertex_arrays[0].positions)
        p.y -= 5;
    const Atlas atlas = first_primitive(16);
    OcclusionOptions options;
    options.rays = 1024;
    const auto at = [&](double reach, std::size_t column, std::size_t row) {
        const OcclusionMap map = map_of(plate, atlas, options, {&fine, reach});
        return static_cast<double>(map.ambient_visibility.ambient[row * 16 + column]);
    };
    EXPECT_NEAR(at(0.5, 1, 1), 1, 1e-3); // next to the pit
    // In its middle, a square of 1 m at a height of 0.2 m is open; a quarter of it by the closed form of
    // parallel rectangles over a corner.
    const double x = 0.5 / 0.2, y = x, a = std::sqrt(1 + x * x);
    const double open = 4 / (2 * 3.14159265) * (x / a * std::atan(y / a) + y / a * std::atan(x / a));
    EXPECT_NEAR(at(0.5, 8, 8), open, 0.02);
    EXPECT_NEAR(at(0.1, 8, 8), 1, 1e-3); // out of reach: the plate itself
}

TEST(OcclusionMaps, ExcludeTexelsInsideSolids) {
    const Scene block = SceneBuilder().sphere({0, 0, 0}, 0.5f, 24).build();
    Scene scene = test::join({floor_at({0, 0}, 1, 4), block});
    const Atlas atlas = first_primitive(32);
    OcclusionOptions options;
    options.rays = 256;
    const OcclusionMap map = map_of(scene, atlas, options);
    const double inside = 3.14159 * 0.25 / 4 * 32 * 32;
    EXPECT_NEAR(static_cast<double>(map.sealed), inside, 0.15 * inside);
    EXPECT_GT(*std::ranges::min_element(map.ambient_visibility.ambient), 0.3f); // and no texel is black
}

} // namespace
} // namespace prt
