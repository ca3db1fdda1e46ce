// Tests occlusion against a tracer that shares only Embree with the baker (DESIGN, "What is blocked"):
// one-sided surfaces block from both sides, and rays start on the open side of every face.

#include "bake/scene/ray_starts.h"
#include "prt/bake/bake.h"
#include "support/reference_tracer.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using std::numbers::pi;
using test::SceneBuilder;

BakeResult bake_kept(const Scene& scene, Inside inside = Inside::keep) {
    BakeOptions options;
    options.order = 3;
    options.rays = 256;
    options.tracer.backend = Backend::cpu;
    options.repairs.inside = inside;
    return bake(scene, options);
}

/// Expects that the estimate of the bake matches its error.
void expect_error_as_estimated(const Scene& scene, Inside inside = Inside::keep) {
    const BakeResult result = bake_kept(scene, inside);
    const double error = test::reference_transfer(scene, 16384)
                             .relative_l2(result.baked.transfer.vectors, receiver_areas(scene));
    testing::Test::RecordProperty("relative_l2", std::to_string(error));
    testing::Test::RecordProperty("estimate", std::to_string(result.statistics.sampling_error));
    EXPECT_LE(error, 1.1 * result.statistics.sampling_error);
    EXPECT_GT(result.statistics.sampling_error, 0.002);
}

/// 4 x 4 m of floor, and 1 m above it 3 x 3 m that face up.
Scene canopy() {
    return SceneBuilder().floor({0, 0, 0}, 2, 8).floor({0, 1, 0}, 1.5f).build();
}

/// Returns the fraction of the cosine-weighted sky that a square of half side `half` at unit height leaves
/// open for the point below its middle (the configuration factor of a parallel rectangle).
double beside_square(double half) {
    const double a = std::sqrt(1 + half * half);
    return 1 - 4 / (2 * pi) * 2 * (half / a * std::atan(half / a));
}

TEST(OneSidedCanopy, LeavesTheFloorTheSkyAroundIt) {
    const Scene scene = canopy();
    const BakeResult result = bake_kept(scene, Inside::refill);
    EXPECT_EQ(result.statistics.receivers.sealed, 0u);
    int middles = 0;
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        if (scene.vertex_arrays[0].positions[p] == glm::vec3(0)) {
            const auto visible = static_cast<double>(result.baked.transfer.vector(p)[0]) * std::sqrt(4 * pi);
            EXPECT_NEAR(visible, beside_square(1.5), 0.02);
            ++middles;
        }
    EXPECT_GT(middles, 3);
}

TEST(OneSidedCanopy, HasTheEstimatedError) {
    expect_error_as_estimated(canopy(), Inside::refill);
}

TEST(OneSidedSheets, HaveTheEstimatedError) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    SceneBuilder builder;
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 middle = vector(), a = 0.5f * glm::normalize(vector()),
                        b = 0.5f * glm::normalize(glm::cross(a, vector()));
        builder.quad(middle - a - b, middle + a - b, middle + a + b, middle - a + b);
    }
    expect_error_as_estimated(builder.build(), Inside::refill);
}

TEST(OneSidedHull, HalfSunkInOneSidedTerrainHasTheEstimatedError) {
    const Scene scene = SceneBuilder()
                            .floor({0, 0, 0}, 2, 8)
                            .transform([](const glm::vec3& p) {
                                return p + glm::vec3(0, 0.2f * std::sin(3 * p.x) * std::cos(2 * p.z), 0);
                            })
                            .sphere({0.01f, 0.03f, 0.02f}, 0.8f, 10) // no vertex of it on the terrain itself
                            .build();
    // Receivers of the terrain under the hull see only the hull's inside: they are sealed.
    const BakeResult refilled = bake_kept(scene, Inside::refill);
    EXPECT_GT(refilled.statistics.receivers.sealed, 20u);
    EXPECT_EQ(refilled.statistics.receivers.refilled, refilled.statistics.receivers.sealed);
    const auto& positions = scene.vertex_arrays[0].positions;
    const test::ReferenceTransfer truth = test::reference_transfer(scene, 1024);
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        if (truth.vectors[p][0] > 0.01) { // light comes from above or below: no repair is needed
            EXPECT_NEAR(static_cast<double>(refilled.baked.transfer.vector(p)[0]), truth.vectors[p][0], 0.04)
                << positions[p].x << " " << positions[p].y << " " << positions[p].z;
        }
    expect_error_as_estimated(scene);
}

TEST(SealedIn, ReceiversUseNeighborsOrStayDark) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 20).sphere({0, 0, 0}, 0.4f, 24).build();
    const auto under = [&](const BakeResult& result) {
        double least = 1, most = 0;
        for (std::size_t p = 0; p < 20 * 20 * 6; ++p)
            if (glm::length(scene.vertex_arrays[0].positions[p]) < 0.35f) {
                const auto visible =
                    static_cast<double>(result.baked.transfer.vector(p)[0]) * std::sqrt(4 * pi);
                least = std::min(least, visible);
                most = std::max(most, visible);
            }
        return std::pair(least, most);
    };
    EXPECT_GT(under(bake_kept(scene, Inside::refill)).first, 0.2);
    const BakeResult kept = bake_kept(scene, Inside::keep);
    EXPECT_EQ(under(kept).second, 0);
    EXPECT_GT(kept.statistics.receivers.sealed, 100u);
    EXPECT_EQ(kept.statistics.receivers.refilled, 0u);
}

TEST(SealedIn, ReceiversBehindAHoleAreNotSealed) {
    // A closed one-sided sphere around a floor, except for one quad, which admits about 0.3 % of the light.
    Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 10).sphere({0, 0, 0}, 0.6f, 12).build();
    auto& triangles = scene.primitives[0].triangles;
    const std::size_t quad = 10 * 10 * 2 + 2 * (3 * 24 + 5);
    triangles.erase(triangles.begin() + quad, triangles.begin() + quad + 2);
    const test::ReferenceTransfer truth = test::reference_transfer(scene, 4096);
    const BakeResult result = bake_kept(scene, Inside::refill);
    for (std::size_t p = 0; p < 10 * 10 * 6; ++p)
        if (glm::length(scene.vertex_arrays[0].positions[p]) < 0.5f) {
            EXPECT_NEAR(static_cast<double>(result.baked.transfer.vector(p)[0]), truth.vectors[p][0], 0.02);
        }
}

TEST(Shell, WithoutShadowTransmitsAllLight) {
    // An outline: a closed hull whose front faces point inwards.
    Scene hull = SceneBuilder().bowl({0, 0, 0}, 3, 8, 0).build();
    const Scene inside = SceneBuilder().floor({0, 0, 0}, 1, 4).sphere({0, 0.5f, 0}, 0.3f, 8).build();
    const auto light = [](const Scene& scene) {
        BakeOptions options;
        options.order = 3;
        options.rays = 64;
        options.repairs.inside = Inside::keep;
        options.repairs.denoise = false; // its steps depend on all that there is
        options.tracer.backend = Backend::cpu;
        return bake(scene, options).baked.transfer;
    };
    const Transfer dark = light(test::join({inside, hull}));
    hull.materials[0].casts_shadow = false;
    const Transfer lit = light(test::join({inside, hull})), alone = light(inside);
    for (std::size_t i = 0; i < alone.vectors.size(); ++i) {
        EXPECT_EQ(dark.vectors[i], 0);
        EXPECT_EQ(lit.vectors[i], alone.vectors[i]);
    }
}

TEST(WallFoot, SeesTheFrontInTheMiddleOfAFloor) {
    // Vertices of the floor are on the wall's lower edge, and the floor continues behind it: half of the sky
    // is visible, plus the part past the wall's ends.
    for (const bool closed : {false, true}) {
        SceneBuilder builder;
        builder.floor({0, 0, 0}, 2, 4).quad({0, 0, 50}, {0, 0, -50}, {0, 100, -50}, {0, 100, 50});
        if (closed) // two sheets, back to back
            builder.quad({0, 0, -50}, {0, 0, 50}, {0, 100, 50}, {0, 100, -50});
        const Scene scene = builder.build();
        const BakeResult result = bake_kept(scene);
        int feet = 0;
        for (std::size_t p = 0; p < 4 * 4 * 6; ++p) {
            const glm::vec3& at = scene.vertex_arrays[0].positions[p];
            if (at.x != 0 || std::abs(at.z) > 1.5f)
                continue;
            ++feet;
            const auto visible = static_cast<double>(result.baked.transfer.vector(p)[0]) * std::sqrt(4 * pi);
            EXPECT_NEAR(visible, 0.5, 0.03) << closed << " " << p;
        }
        EXPECT_EQ(feet, 3 * 6);
    }
}

TEST(WallFoot, IsNotBlackWithSharedVertices) {
    // The vertices' faces surround them, so that only the wall determines a side.
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2, 4).build();
    VertexArray& vertices = scene.vertex_arrays[0];
    for (glm::uvec3& t : scene.primitives[0].triangles)
        for (int corner = 0; corner < 3; ++corner)
            for (unsigned v = 0; v < t[corner]; ++v)
                if (vertices.positions[v] == vertices.positions[t[corner]]) {
                    t[corner] = v;
                    break;
                }
    const Scene wall = SceneBuilder().quad({0, 0, 50}, {0, 0, -50}, {0, 100, -50}, {0, 100, 50}).build();
    const Scene both = test::join({scene, wall});
    const BakeResult result = bake_kept(both);
    const std::vector<float> areas = receiver_areas(both);
    int feet = 0;
    for (std::size_t p = 0; p < vertices.size(); ++p)
        if (areas[p] > 0 && vertices.positions[p].x == 0) {
            ++feet;
            EXPECT_NEAR(static_cast<double>(result.baked.transfer.vector(p)[0]) * std::sqrt(4 * pi), 0.5,
                        0.03)
                << p;
        }
    EXPECT_EQ(feet, 5);
}

/// Returns a strip of cells along x, 1 wide; normals of the edge at z = 0 lean towards +z by `degrees`.
Scene leaning_strip(double degrees) {
    Scene scene;
    VertexArray vertices;
    std::vector<glm::uvec3> triangles;
    const double angle = degrees * pi / 180;
    for (unsigned i = 0; i <= 20; ++i) {
        for (const float z : {0.0f, 1.0f}) {
            vertices.positions.emplace_back(0.5f * static_cast<float>(i), 0, z);
            vertices.normals.push_back(z == 0 ? glm::vec3(0, std::cos(angle), std::sin(angle))
                                              : glm::vec3(0, 1, 0));
        }
        if (i == 20)
            break;
        triangles.emplace_back(2 * i, 2 * i + 1, 2 * i + 3);
        triangles.emplace_back(2 * i, 2 * i + 3, 2 * i + 2);
    }
    scene.vertex_arrays.push_back(std::move(vertices));
    scene.materials.emplace_back();
    Primitive primitive;
    primitive.triangles = std::move(triangles);
    scene.primitives.push_back(std::move(primitive));
    return scene;
}

class TiltedNormal : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Degrees, TiltedNormal, testing::Values(10.0, 40.0, 50.0, 70.0, 85.0));

TEST_P(TiltedNormal, LosesOnlyTheSkyBelowItsFace) {
    // The plane cuts (1 - cos a) / 2 off the cosine-weighted hemisphere of a normal that leans by a.
    for (const bool double_sided : {false, true}) {
        const Scene scene = test::painted(leaning_strip(GetParam()), glm::vec3(1), double_sided);
        const BakeResult result = bake_kept(scene);
        const double open = (1 + std::cos(GetParam() * pi / 180)) / 2;
        // in the middle; the strip's width leaves a small part open
        for (const std::size_t p : {16u, 20u, 24u})
            EXPECT_NEAR(static_cast<double>(result.baked.transfer.vector(p)[0]) * std::sqrt(4 * pi), open,
                        0.04)
                << p;
        EXPECT_EQ(result.statistics.receivers.sealed, 0u);
    }
}

/// Adds a closed box of `cells` x `cells` quads per side; vertices are shared and their normals smooth: at
/// edges they tilt 45 degrees from the faces, at corners 55.
void add_smooth_box(Scene& scene, const glm::vec3& low, const glm::vec3& high, int cells) {
    VertexArray& vertices = scene.vertex_arrays[0];
    const auto vertex = [&](const glm::ivec3& at) {
        const glm::vec3 p = low + (high - low) * glm::vec3(at) / static_cast<float>(cells);
        glm::vec3 normal(0);
        for (int axis = 0; axis < 3; ++axis)
            normal[axis] = at[axis] == 0 ? -1.0f : at[axis] == cells ? 1.0f : 0.0f;
        normal = glm::normalize(normal);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (vertices.positions[v] == p && vertices.normals[v] == normal)
                return static_cast<unsigned>(v);
        vertices.positions.push_back(p);
        vertices.normals.push_back(normal);
        return static_cast<unsigned>(vertices.size() - 1);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, cells})
            for (int i = 0; i < cells; ++i)
                for (int j = 0; j < cells; ++j) {
                    const auto corner = [&](int u, int v) {
                        glm::ivec3 at;
                        at[axis] = side;
                        at[(axis + 1) % 3] = i + (side > 0 ? u : v);
                        at[(axis + 2) % 3] = j + (side > 0 ? v : u);
                        return vertex(at);
                    };
                    const unsigned a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                    scene.primitives[0].triangles.emplace_back(a, b, c);
                    scene.primitives[0].triangles.emplace_back(a, c, d);
                }
}

/// Returns a person made of boxes with gaps of a centimetre.
Scene box_figure() {
    Scene scene;
    scene.vertex_arrays.emplace_back();
    scene.materials.emplace_back();
    scene.primitives.emplace_back();
    for (const float side : {-1.0f, 1.0f}) {
        const auto limb = [&](const glm::vec3& low, const glm::vec3& high) {
            const glm::vec3 mirror(side, 1, 1);
            add_smooth_box(scene, glm::min(mirror * low, mirror * high),
                           glm::max(mirror * low, mirror * high), 3);
        };
        limb({0.02f, 0, -0.1f}, {0.19f, 0.8f, 0.1f});      // leg
        limb({0.26f, 0.75f, -0.08f}, {0.4f, 1.4f, 0.08f}); // arm
    }
    add_smooth_box(scene, {-0.25f, 0.81f, -0.13f}, {0.25f, 1.42f, 0.13f}, 3);
    add_smooth_box(scene, {-0.12f, 1.43f, -0.12f}, {0.12f, 1.7f, 0.12f}, 3);
    return scene;
}

TEST(SmoothBoxes, FiguresHaveTheEstimatedError) {
    expect_error_as_estimated(box_figure(), Inside::refill);
}

TEST(RayStart, IsAboveEveryFaceOfRandomFans) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    int leaning = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        // A fan round the origin that rises and falls by up to 45 degrees, and a normal that leans anyhow.
        const int count = 3 + trial % 7;
        SceneBuilder builder;
        std::vector<glm::vec3> rim;
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * pi * (i + 0.3 * unit(random)) / count;
            rim.emplace_back(std::sin(angle), unit(random), std::cos(angle));
        }
        for (std::size_t i = 0; i < rim.size(); ++i)
            builder.triangle({0, 0, 0}, rim[i], rim[(i + 1) % rim.size()]);
        Scene scene = builder.build();
        VertexArray& vertices = scene.vertex_arrays[0];
        glm::dvec3 mean(0);
        std::vector<glm::dvec3> faces;
        for (const glm::uvec3& t : scene.primitives[0].triangles) {
            faces.push_back(glm::dvec3(vertices.normals[t.x]));
            mean += faces.back() * static_cast<double>(glm::length(
                                       glm::cross(vertices.positions[t.y] - vertices.positions[t.x],
                                                  vertices.positions[t.z] - vertices.positions[t.x])));
        }
        const glm::vec3 normal(glm::normalize(glm::normalize(mean) +
                                              1.2 * glm::dvec3(unit(random), unit(random), unit(random))));
        for (glm::uvec3& t : scene.primitives[0].triangles)
            t.x = 0; // all share the first vertex
        vertices.normals[0] = normal;
        const glm::dvec3 start(ray_starts(scene, Side::front)[0]), back(ray_starts(scene, Side::back)[0]);
        double least = 1, min_mean = 1, max_back = -1;
        for (const glm::dvec3& face : faces) {
            least = std::min(least, glm::dot(start, face));
            min_mean = std::min(min_mean, glm::dot(mean, face));
            max_back = std::max(max_back, glm::dot(back, face));
            leaning += glm::dot(face, glm::dvec3(normal)) < 0.7;
        }
        if (min_mean <= 0.1 * glm::length(mean) || glm::dot(mean, glm::dvec3(normal)) <= 0)
            continue; // then no point need be above all faces, or the normal points to the back of the fan
        EXPECT_GE(least, 0.45) << trial;
        EXPECT_LE(max_back, -0.45) << trial;
        EXPECT_LE(glm::length(start), 21) << trial;
    }
    EXPECT_GT(leaning, 1000);
}

} // namespace
} // namespace prt
