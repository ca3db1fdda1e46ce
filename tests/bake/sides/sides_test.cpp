// Double-sided surfaces, and surfaces that a mesh holds twice.

#include "bake/refine/sides.h"

#include "bake/scene/opposite_triangles.h"
#include "prt/bake/bake.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::SceneBuilder, test::with_opposites;

struct Box {
    glm::vec3 low, high;
    bool open = false;  ///< no side at +X
    bool twice = false; ///< an opposite triangle at each of its triangles
};

SceneBuilder& add(SceneBuilder& scene, const Box& box) {
    const glm::vec3 &l = box.low, &h = box.high;
    const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
        scene.quad(a, b, c, d);
        if (box.twice)
            scene.quad(a, d, c, b);
    };
    quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
    quad({h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z});
    quad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z});
    quad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
    quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
    if (!box.open)
        quad({h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z});
    return scene;
}

Scene scene_of(const Box& box) {
    SceneBuilder builder;
    return add(builder, box).build();
}

constexpr Box kClosed{{-1, 0, -1}, {1, 2, 1}}, kOpen{{-1, 0, -1}, {1, 2, 1}, true},
    kOpenTwice{{-1, 0, -1}, {1, 2, 1}, true, true}, kClosedTwice{{-1, 0, -1}, {1, 2, 1}, false, true};

glm::vec3 point_of(const Scene& scene, unsigned triangle, const glm::vec2& uv) {
    const glm::uvec3& t = scene.primitives[0].triangles[triangle];
    const std::vector<glm::vec3>& at = scene.vertex_arrays[0].positions;
    return (1 - uv.x - uv.y) * at[t.x] + uv.x * at[t.y] + uv.y * at[t.z];
}

TEST(OppositeTriangles, HaveEqualPointsForAllFirstCorners) {
    const glm::vec3 corners[] = {{1, 2, 3}, {4, 1, 0}, {-2, 0, 5}};
    for (int start = 0; start < 3; ++start) {
        const Scene scene = SceneBuilder()
                                .triangle(corners[0], corners[1], corners[2])
                                .triangle(corners[start], corners[(start + 2) % 3], corners[(start + 1) % 3])
                                .build();
        const OppositeTriangles opposites(scene);
        for (const unsigned from : {0u, 1u}) {
            unsigned triangle = from;
            glm::vec2 uv(0.2f, 0.7f);
            const glm::vec3 before = point_of(scene, triangle, uv);
            ASSERT_TRUE(opposites.move_to_front(triangle, uv));
            EXPECT_EQ(triangle, 1 - from);
            EXPECT_LT(glm::distance(point_of(scene, triangle, uv), before), 1e-6f) << start;
        }
    }
}

TEST(OppositeTriangles, AreSingleSidedAndOfOneMesh) {
    const Scene pair = SceneBuilder()
                           .triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})
                           .triangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0})
                           .build();
    EXPECT_FALSE(OppositeTriangles(pair).empty());
    EXPECT_TRUE(OppositeTriangles(test::painted(pair, glm::vec3(1), /*double_sided=*/true)).empty());
    const Scene same = SceneBuilder()
                           .triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})
                           .triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 0})
                           .build();
    EXPECT_TRUE(OppositeTriangles(same).empty());
    const Scene separate = test::join({SceneBuilder().triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).build(),
                                       SceneBuilder().triangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}).build()});
    EXPECT_TRUE(OppositeTriangles(separate).empty());
}

TEST(OppositeTriangles, GoInPairs) {
    SceneBuilder builder;
    for (int i = 0; i < 2; ++i)
        builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).triangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    const Scene scene = builder.build();
    const OppositeTriangles opposites(scene);
    for (unsigned t = 0; t < 4; ++t) {
        unsigned other = t;
        glm::vec2 uv(0.5f, 0.25f);
        ASSERT_TRUE(opposites.move_to_front(other, uv));
        EXPECT_NE(other % 2, t % 2);
        ASSERT_TRUE(opposites.move_to_front(other, uv));
        EXPECT_EQ(other, t);
    }
}

/// Two triangles of one side share the one of the other.
TEST(OppositeTriangles, RepresentSeveralTrianglesOfASide) {
    SceneBuilder builder;
    builder.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    builder.triangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}).triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0});
    const Scene scene = builder.build();
    const OppositeTriangles opposites(scene);
    for (const auto& [from, to] : {std::pair{0u, 2u}, {1u, 2u}, {2u, 0u}}) {
        unsigned other = from;
        glm::vec2 uv(0.5f, 0.25f);
        ASSERT_TRUE(opposites.move_to_front(other, uv)) << from;
        EXPECT_EQ(other, to);
    }
    unsigned without_area = 3;
    glm::vec2 uv(0);
    EXPECT_FALSE(opposites.move_to_front(without_area, uv));
}

double shown(const Transfer& transfer, std::size_t receiver) {
    double sum = 0;
    for (std::size_t from = 0; from < transfer.dimension(); ++from) // one coefficient of each part
        sum += static_cast<double>(transfer.vector(receiver)[from]);
    return sum * std::sqrt(4 * std::numbers::pi);
}

/// White walls that are there twice reflect all of a uniform sky, inside and outside. A ray that took the
/// back of one for a wall would lose it.
TEST(DuplicateWalls, ReflectAllOfAUniformSky) {
    BakeOptions options;
    options.order = 1;
    options.rays = 256;
    options.bounces = kEndlessBounces;
    options.tracer.backend = Backend::cpu;
    const Scene scene = test::painted(scene_of(kOpenTwice), glm::vec3(1));
    const BakeResult result = bake(scene, options);
    EXPECT_GT(result.statistics.gather.entries, 0u);
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        EXPECT_NEAR(shown(result.baked.transfer, p), 1, 1e-3) << p;
}

/// No light enters, but no receiver is inside an object.
TEST(DuplicateWalls, AreDarkInAClosedRoom) {
    BakeOptions options;
    options.order = 1;
    options.rays = 256;
    options.tracer.backend = Backend::cpu;
    const Scene scene = scene_of(kClosedTwice);
    const BakeResult result = bake(scene, options);
    EXPECT_TRUE(result.sealed.empty());
    const VertexArray& vertices = scene.vertex_arrays[0];
    for (std::size_t p = 0; p < scene.receivers(); ++p) {
        const bool inside = glm::dot(vertices.normals[p], glm::vec3(0, 1, 0) - vertices.positions[p]) > 0;
        EXPECT_NEAR(shown(result.baked.transfer, p), inside ? 0 : 1, 1e-6) << p;
    }
}

constexpr float kPassed = 0.4f, kBase = 0.5f;
const glm::vec3 kThrough(0.25f, 0.5f, 1);

Scene sheet(const glm::vec3& centre) {
    Scene leaf = test::painted(SceneBuilder().floor(centre, 1).build(), glm::vec3(kBase), true);
    leaf.materials[0].transmission.factor = kPassed;
    leaf.materials[0].transmission.color = kThrough;
    return leaf;
}

/// Under a sky that is bright above only, over black ground, a sheet reflects on its upper side and passes
/// light to its lower one.
TEST(SheetsWithBothSides, ShowReflectedAndPassedLight) {
    const Scene scene =
        test::join({with_opposites(sheet({0, 1, 0})),
                    test::painted(SceneBuilder().floor({0, 0, 0}, 100).build(), glm::vec3(0))});
    BakeOptions options;
    options.order = 3;
    options.rays = 256;
    options.lamps.mode = LampMode::none;
    options.tracer.backend = Backend::cpu;
    const BakeResult result = bake(scene, options);
    const TransferLayout& layout = result.baked.transfer.layout;
    ASSERT_EQ(layout.channels(), 3);
    std::array<double, 9> above{};
    clamped_cosine_lobe(3, {0, 1, 0}, above);
    for (std::size_t p = 0; p < scene.vertex_arrays[0].size(); ++p) {
        const bool up = scene.vertex_arrays[0].normals[p].y > 0;
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 9; ++i) {
                const double share = up ? 1 - kPassed : kPassed * kThrough[static_cast<int>(c)] / kBase;
                EXPECT_NEAR(result.baked.transfer.vector(p)[c * 9 + i], share * above[i], 0.01) << p;
            }
    }
}

/// The vertices of the two sides have the light of sheets that face up and down.
TEST(SheetsWithBothSides, HaveTheLightOfMirroredSheets) {
    const Scene floor = test::painted(SceneBuilder().floor({0, 0, 0}, 1.5f).build(), {0.8f, 0.4f, 0.2f});
    BakeOptions options;
    options.order = 2;
    options.rays = 4096;
    options.bounces = 2;
    options.tracer.backend = Backend::cpu;
    Scene up = sheet({0, 0.5f, 0}), down = up;
    for (glm::uvec3& t : down.primitives[0].triangles)
        std::swap(t.y, t.z);
    for (glm::vec3& normal : down.vertex_arrays[0].normals)
        normal = -normal;
    const Transfer separate = bake(test::join({with_opposites(up), floor}), options).baked.transfer;
    std::size_t first = 0;
    for (const Scene& one : {up, down}) {
        const Transfer alone = bake(test::join({one, floor}), options).baked.transfer;
        ASSERT_EQ(alone.dimension(), separate.dimension());
        for (std::size_t p = 0; p < one.receivers(); ++p)
            for (std::size_t i = 0; i < alone.dimension(); ++i)
                EXPECT_NEAR(separate.vector(first + p)[i], alone.vector(p)[i], 0.02) << p << " " << i;
        first += one.receivers();
    }
}

/// A pane of two opposite triangles stops its share of the light once.
TEST(GlassWithBothSides, PassesLightOnce) {
    Scene pane = SceneBuilder()
                     .floor({0, 0, 0}, 20, 8)
                     .transform([](const glm::vec3& p) {
                         return glm::vec3(p.x, 0.3f + 0.013f * p.x + 0.0071f * p.z, 0.97f * p.z);
                     })
                     .build();
    pane.materials[0].double_sided = true;
    pane.materials[0].glass.factor = 0.5f;
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 0.3f).build();
    BakeOptions options;
    options.order = 1;
    options.rays = 256;
    options.tracer.backend = Backend::cpu;
    const auto under = [&](const Scene& cover) {
        const Scene scene = test::join({floor, cover});
        return shown(bake(scene, options).baked.transfer, 0);
    };
    EXPECT_NEAR(under(pane), 0.5, 0.02);
    EXPECT_NEAR(under(with_opposites(pane)), 0.5, 0.02);
}

std::size_t separated(const Scene& scene, const BakeOptions& options = {}) {
    const std::vector<bool> triangles = sides_to_separate(scene, options);
    return static_cast<std::size_t>(std::ranges::count(triangles, true));
}

Scene double_sided(const Scene& scene) {
    return test::painted(scene, glm::vec3(0.5f), /*double_sided=*/true);
}

TEST(SidesToSeparate, IncludeAnOpenBox) {
    EXPECT_EQ(separated(double_sided(scene_of(kOpen))), 10u);
    EXPECT_TRUE(sides_to_separate(scene_of(kOpen), {}).empty()); // one-sided
}

TEST(SidesToSeparate, ExcludeClosedSpaces) {
    EXPECT_EQ(separated(double_sided(scene_of(kClosed))), 0u);
}

/// The bottom of the box and the floor under it are one plane.
TEST(SidesToSeparate, ExcludeABoxOnAFloor) {
    EXPECT_EQ(separated(double_sided(
                  test::join({scene_of(kClosed), SceneBuilder().floor({0, 0, 0}, 5, 3).build()}))),
              0u);
}

TEST(SidesToSeparate, ExcludeGround) {
    EXPECT_EQ(separated(double_sided(SceneBuilder().floor({0, 0, 0}, 5, 3).build())), 0u);
}

TEST(SidesToSeparate, AreLitByALampInside) {
    Scene scene = double_sided(scene_of(kClosed));
    PunctualLight light;
    light.position = {0.2f, 1, 0.3f};
    scene.lights = {light};
    EXPECT_EQ(separated(scene), 12u);
    BakeOptions without;
    without.lamps.mode = LampMode::none;
    EXPECT_EQ(separated(scene, without), 0u);
    scene.lights[0].position = {0.2f, 3, 0.3f};
    EXPECT_EQ(separated(scene), 0u);
}

/// An emissive sphere lights its room, and stays dark inside except for its emission.
TEST(SidesToSeparate, AreLitByEmission) {
    Scene scene =
        double_sided(test::join({scene_of(kClosed), SceneBuilder().sphere({0, 1, 0}, 0.1f, 4).build()}));
    scene.materials[1].double_sided = false;
    scene.materials[1].emission.radiance = glm::vec3(1);
    EXPECT_EQ(separated(scene), 12u);
}

TEST(SidesToSeparate, IncludeOnlyLitPieces) {
    SceneBuilder builder;
    add(builder, kClosed);
    add(builder, {{4, 0, -1}, {6, 2, 1}, true});
    const Scene scene = double_sided(builder.build());
    const std::vector<bool> triangles = sides_to_separate(scene, {});
    ASSERT_EQ(triangles.size(), 22u);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        EXPECT_EQ(triangles[t], t >= 12) << t;
}

/// The back is the side that is seen.
TEST(SidesToSeparate, IncludeOnlyLitBacks) {
    const Scene ground =
        SceneBuilder().quad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}).build(); // looks down
    EXPECT_EQ(separated(double_sided(ground)), 2u);
    const Scene inverted = SceneBuilder().bowl({0, 1, 0}, 1, 4, 0).build(); // looks inside, and is closed
    EXPECT_GT(separated(double_sided(inverted)), 0u);
}

/// A room of four metres with a window of half a metre, for any seed.
TEST(SidesToSeparate, AreLitThroughASmallWindow) {
    SceneBuilder builder;
    add(builder, {{-2, 0, -2}, {2, 3, 2}, true});
    const float l = -0.25f, h = 0.25f; // the wall at +X, round the window
    builder.quad({2, 0, 2}, {2, 0, -2}, {2, 1 + l, -2}, {2, 1 + l, 2});
    builder.quad({2, 1 + h, 2}, {2, 1 + h, -2}, {2, 3, -2}, {2, 3, 2});
    builder.quad({2, 1 + l, 2}, {2, 1 + l, h}, {2, 1 + h, h}, {2, 1 + h, 2});
    builder.quad({2, 1 + l, l}, {2, 1 + l, -2}, {2, 1 + h, -2}, {2, 1 + h, l});
    const Scene room =
        double_sided(test::join({builder.build(), SceneBuilder().floor({0, 0, 0}, 20).build()}));
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        BakeOptions options;
        options.seed = seed;
        EXPECT_EQ(separated(room, options), 18u) << seed;
    }
}

/// A box connected to a plain that is invisible from below: the triangles of the plain in a common patch with
/// the box get back sides, too.
TEST(SidesToSeparate, IncludeABoxOnAPlain) {
    SceneBuilder builder;
    builder.floor({0, 0, 0}, 100, 40);
    add(builder, {{0, 0, 0}, {5, 2, 5}, true});
    const Scene scene = double_sided(builder.build());
    const std::vector<bool> triangles = sides_to_separate(scene, {});
    ASSERT_EQ(triangles.size(), 3210u);
    for (std::size_t t = 3200; t < triangles.size(); ++t)
        EXPECT_TRUE(triangles[t]) << t;
    EXPECT_LT(std::ranges::count(triangles, true), 100);
}

TEST(SidesToSeparate, ExcludeBlendedSurfaces) {
    const Scene open = double_sided(scene_of(kOpen));
    const auto changed = [&](void (*change)(Material&)) {
        Scene scene = open;
        change(scene.materials[0]);
        return separated(scene);
    };
    EXPECT_EQ(changed([](Material& m) { m.alpha_mode = AlphaMode::blend; }), 0u);
    EXPECT_EQ(changed([](Material& m) { m.alpha_mode = AlphaMode::mask; }), 10u);
    EXPECT_EQ(changed([](Material& m) { m.glass.factor = 0.5f; }), 10u);
    EXPECT_EQ(changed([](Material& m) { m.transmission.factor = 0.5f; }), 10u);
}

/// Light from above passes sheets: the lower side of one, and the inside of a closed box of them.
TEST(SidesToSeparate, AreLitThroughSheets) {
    for (const Scene& scene : {SceneBuilder().floor({0, 0, 0}, 1).build(), scene_of(kClosed)}) {
        Scene leaf = double_sided(scene);
        EXPECT_EQ(separated(leaf), 0u);
        leaf.materials[0].transmission.factor = 0.5f;
        EXPECT_EQ(separated(leaf), leaf.triangles());
    }
}

} // namespace
} // namespace prt
