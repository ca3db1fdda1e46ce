// Tests splitting of triangles: no cracks, no hanging nodes, no thin triangles.

#include "bake/refine/bisection.h"

#include "support/scene_builder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tuple>

namespace prt {
namespace {

using test::SceneBuilder;

struct Less {
    bool operator()(const glm::vec3& a, const glm::vec3& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};
using Ends = std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>;

std::array<glm::vec3, 3> corners(const Scene& scene, std::size_t primitive, const glm::uvec3& t) {
    const std::vector<glm::vec3>& at = scene.vertex_arrays[scene.primitives[primitive].vertices].positions;
    return {at[t.x], at[t.y], at[t.z]};
}

/// Counts the triangles of each edge, by the positions of its ends; edges without length are ignored.
std::map<Ends, int> edge_uses(const Scene& scene) {
    std::map<Ends, int> uses;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const auto c = corners(scene, p, t);
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::vec3 &a = c[i], &b = c[(i + 1) % 3];
                if (a != b)
                    ++uses[std::minmax(std::tuple(a.x, a.y, a.z), std::tuple(b.x, b.y, b.z))];
            }
        }
    return uses;
}

std::size_t points(const Scene& scene) {
    std::set<glm::vec3, Less> all;
    for (const VertexArray& vertices : scene.vertex_arrays)
        all.insert(vertices.positions.begin(), vertices.positions.end());
    return all.size();
}

double area(const Scene& scene) {
    double sum = 0;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const auto c = corners(scene, p, t);
            sum += 0.5 * glm::length(glm::cross(glm::dvec3(c[1] - c[0]), glm::dvec3(c[2] - c[0])));
        }
    return sum;
}

/// Returns the minimum angle of triangles with an area, radians.
double min_angle(const Scene& scene) {
    double least = std::numbers::pi;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const auto c = corners(scene, p, t);
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::dvec3 a(c[(i + 1) % 3] - c[i]), b(c[(i + 2) % 3] - c[i]);
                least = std::min(least, std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
            }
        }
    return least;
}

Scene split_at(const Scene& scene, const std::vector<std::uint32_t>& triangles) {
    const WeldedEdges edges = welded_edges(scene);
    EdgeMarks marks(edges);
    for (const std::uint32_t t : triangles)
        marks.mark(edges.of_triangle[t][edges.longest[t]]);
    const Bisection bisection = bisect(scene, edges, marks);
    EXPECT_EQ(bisection.refinement.vertices(), marks.vertices());
    EXPECT_EQ(bisection.parts.size(), refined(scene, bisection.refinement).triangles());
    return refined(scene, bisection.refinement);
}

/// Some triangles by chance, `rounds` times.
Scene split_by_chance(Scene scene, int rounds, unsigned seed = 1) {
    std::mt19937 random(seed);
    for (int round = 0; round < rounds; ++round) {
        std::vector<std::uint32_t> some;
        for (std::uint32_t t = 0; t < scene.triangles(); ++t)
            if (random() % 5 == 0)
                some.push_back(t);
        scene = split_at(scene, some);
    }
    return scene;
}

TEST(Bisection, KeepsAClosedMeshClosed) {
    const Scene sphere = SceneBuilder()
                             .sphere({0, 0, 0}, 1, 5)
                             .transform([](const glm::vec3& p) { // its ends meet up to rounding
                                 return glm::round(p * 1024.0f) / 1024.0f;
                             })
                             .build();
    const Scene finer = split_by_chance(sphere, 6);
    EXPECT_GT(finer.triangles(), 4 * sphere.triangles());
    const std::map<Ends, int> uses = edge_uses(finer);
    for (const auto& [ends, count] : uses)
        EXPECT_EQ(count % 2, 0);
    // Euler's characteristic of a sphere; its poles have triangles that are points or lines.
    std::size_t faces = 0;
    for (const glm::uvec3& t : finer.primitives[0].triangles) {
        const auto c = corners(finer, 0, t);
        faces += c[0] != c[1] && c[1] != c[2] && c[2] != c[0] ? 1 : 0;
    }
    EXPECT_EQ(static_cast<int>(points(finer)) - static_cast<int>(uses.size()) + static_cast<int>(faces), 2);
    EXPECT_NEAR(area(finer), area(sphere), 1e-5 * area(sphere));
}

/// Two materials, and texture coordinates that jump along z = 0, over one floor.
Scene floor_of_two() {
    Scene scene = test::join({SceneBuilder().quad({-1, 0, 1}, {1, 0, 1}, {1, 0, 0}, {-1, 0, 0}).build(),
                              SceneBuilder().quad({-1, 0, 0}, {1, 0, 0}, {1, 0, -1}, {-1, 0, -1}).build()});
    for (VertexArray& vertices : scene.vertex_arrays) {
        vertices.texcoords.resize(1);
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords[0].emplace_back(p.x, p.z);
    }
    for (glm::vec2& uv : scene.vertex_arrays[1].texcoords[0])
        uv += 7.0f;
    return scene;
}

TEST(Bisection, FixedEdgesAreThoseWhoseMarksReachAKeptTriangle) {
    const Scene scene = split_by_chance(SceneBuilder().sphere({0, 0, 0}, 1, 4).build(), 2);
    const WeldedEdges edges = welded_edges(scene);
    std::mt19937 random(3);
    std::vector<bool> kept(scene.triangles());
    for (std::size_t t = 0; t < kept.size(); ++t)
        kept[t] = random() % 40 == 0;
    const std::vector<bool> fixed = fixed_edges(edges, kept);
    EXPECT_GT(std::ranges::count(fixed, false), 0);
    for (std::uint32_t e = 0; e < edges.lengths.size(); ++e) {
        EdgeMarks marks(edges);
        marks.mark(e);
        bool reached = false;
        for (std::size_t t = 0; t < kept.size(); ++t)
            for (const std::uint32_t of : edges.of_triangle[t])
                reached = reached || (kept[t] && marks.marked(of));
        EXPECT_EQ(fixed[e], reached) << e;
    }
}

TEST(Bisection, SplitsBothSidesOfASeam) {
    const Scene finer = split_by_chance(floor_of_two(), 7);
    std::size_t along[2] = {0, 0};
    for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t v = 0; v < finer.vertex_arrays[a].size(); ++v) {
            const glm::vec3& p = finer.vertex_arrays[a].positions[v];
            along[a] += p.z == 0 ? 1 : 0;
            EXPECT_EQ(finer.vertex_arrays[a].texcoords[0][v],
                      glm::vec2(p.x, p.z) + (a == 0 ? 0.0f : 7.0f)); // linear, on its own side
        }
    EXPECT_EQ(along[0], along[1]);
    EXPECT_GT(along[0], 2);
    for (const auto& [ends, count] : edge_uses(finer)) {
        const auto& [ax, ay, az] = ends.first;
        const auto& [bx, by, bz] = ends.second;
        const bool rim = (ax == bx && std::abs(ax) == 1) || (az == bz && std::abs(az) == 1);
        EXPECT_EQ(count, rim ? 1 : 2); // one inside: a vertex hangs there
    }
}

TEST(Bisection, KeepsAnglesAfterRepetition) {
    const Scene one = SceneBuilder().triangle({0, 0, 0}, {3, 0, 0.2f}, {0.7f, 0, -1}).build();
    Scene finer = one;
    for (int round = 0; round < 12; ++round) { // towards one corner
        const WeldedEdges edges = welded_edges(finer);
        std::uint32_t nearest = 0;
        double least = 1e30;
        for (std::uint32_t t = 0; t < finer.triangles(); ++t) {
            const auto c = corners(finer, 0, finer.primitives[0].triangles[t]);
            if (const double d = glm::length(glm::dvec3(c[0] + c[1] + c[2])); d < least) {
                least = d;
                nearest = t;
            }
        }
        finer = split_at(finer, {nearest});
    }
    // At least half of the original minimum (Rosenberg and Stenger 1975).
    EXPECT_GE(min_angle(finer), 0.5 * min_angle(one) - 1e-4);
    EXPECT_NEAR(area(finer), area(one), 1e-6);
}

TEST(Bisection, AcceptsDegenerateMeshes) {
    SceneBuilder builder;
    builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    builder.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});        // duplicated
    builder.triangle({0, 0, 0}, {1, 0, 0}, {0.5f, -1, 0});           // a third at an edge
    builder.triangle({0, 0, 0}, {0.5f, 0, 0}, {1, 0, 0});            // no area: over an edge
    builder.triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0});               // a line
    builder.triangle({2, 2, 2}, {2, 2, 2}, {2, 2, 2});               // a point
    builder.triangle({0, 1, 0}, {1, 1, 0}, {0.5f, 1.0f + 1e-6f, 0}); // a needle
    Scene scene = builder.build();
    scene.vertex_arrays[0].positions.emplace_back(9, 9, 9); // unused by triangles
    scene.vertex_arrays[0].normals.emplace_back(0, 1, 0);
    const Scene finer = split_by_chance(scene, 5);
    EXPECT_GT(finer.triangles(), 2 * scene.triangles());
    EXPECT_NEAR(area(finer), area(scene), 1e-6);
    std::map<Ends, int> uses = edge_uses(finer);
    int duplicated = 0;
    for (const auto& [ends, count] : uses) { // both copies are split in the same way
        const auto& [ax, ay, az] = ends.first;
        const auto& [bx, by, bz] = ends.second;
        if (ay > 0 && ay < 1 && by > 0 && by < 1) {
            EXPECT_GE(count, 2);
            ++duplicated;
        }
    }
    EXPECT_GT(duplicated, 0);
}

TEST(Bisection, PiecesFillTheirTriangles) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1, 2).build();
    const WeldedEdges edges = welded_edges(scene);
    for (const std::set<std::uint32_t>& slots :
         std::vector<std::set<std::uint32_t>>{{0}, {0, 1}, {0, 2}, {0, 1, 2}}) {
        EdgeMarks marks(edges);
        for (const std::uint32_t slot : slots)
            marks.mark(edges.of_triangle[3][(edges.longest[3] + slot) % 3]);
        const Bisection bisection = bisect(scene, edges, marks);
        const Scene finer = refined(scene, bisection.refinement);
        std::vector<double> areas(scene.triangles());
        for (std::size_t t = 0; t < bisection.parts.size(); ++t) {
            const Part& part = bisection.parts[t];
            const auto c = corners(finer, 0, finer.primitives[0].triangles[t]),
                       whole = corners(scene, 0, scene.primitives[0].triangles[part.whole]);
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::vec2 uv(part.corners[i]);
                EXPECT_LT(
                    glm::distance(c[i], whole[0] * (1 - uv.x - uv.y) + whole[1] * uv.x + whole[2] * uv.y),
                    1e-6f);
            }
            const glm::dvec2 u = part.corners[1] - part.corners[0], v = part.corners[2] - part.corners[0];
            EXPECT_GT(u.x * v.y - u.y * v.x, 0); // orientation of the whole triangle
            areas[part.whole] += u.x * v.y - u.y * v.x;
        }
        for (const double sum : areas)
            EXPECT_DOUBLE_EQ(sum, 1);
    }
}

TEST(Bisection, InStepsEqualsOneRefinement) {
    const Scene scene = floor_of_two();
    Refinement all = no_refinement(scene);
    Scene finer = scene;
    for (int round = 0; round < 4; ++round) {
        const WeldedEdges edges = welded_edges(finer);
        EdgeMarks marks(edges);
        marks.mark(edges.of_triangle[0][edges.longest[0]]);
        Bisection bisection = bisect(finer, edges, marks);
        finer = refined(finer, bisection.refinement);
        append(all, std::move(bisection.refinement));
    }
    const Scene at_once = refined(scene, all);
    ASSERT_EQ(at_once.receivers(), finer.receivers());
    for (std::size_t a = 0; a < finer.vertex_arrays.size(); ++a)
        EXPECT_EQ(at_once.vertex_arrays[a].positions, finer.vertex_arrays[a].positions);
    for (std::size_t p = 0; p < finer.primitives.size(); ++p)
        EXPECT_EQ(at_once.primitives[p].triangles, finer.primitives[p].triangles);
}

} // namespace
} // namespace prt
