// Tests light of level 0 on coarser levels: nearest points, exactness, closed forms, and comparison with a
// separate bake of a level.

#include "bake/products/levels/nearest_points.h"
#include "bake/scene/receivers.h"
#include "prt/bake/level_bake.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

namespace prt {
namespace levels_of_detail {

using test::SceneBuilder;

/// Returns `coarser` as level 1 of `finest`, together with the scenes of `around`.
LeveledScene leveled(const Scene& finest, const Scene& coarser, const std::vector<Scene>& around = {}) {
    std::vector<Scene> parts = {finest};
    parts.insert(parts.end(), around.begin(), around.end());
    LeveledScene result;
    result.finest_primitives = parts.size();
    for (const Scene& part : parts)
        result.finest_receivers += part.receivers();
    parts.push_back(coarser);
    result.scene = test::join(parts);
    result.nodes = {{0, "node 0", false, {0}, {{1, 1, "node 1", {parts.size() - 1}}}}};
    return result;
}

Transfer zeros(const Scene& scene, int order = 2) {
    return zero_transfer(layout_of_one(order, 1, TermKind::direct), scene.receivers());
}

/// Transfer as a function of positions and normals.
using Light = std::function<float(const glm::vec3& position, const glm::vec3& normal, std::size_t column)>;
Transfer transfer_of(const Scene& scene, const Light& light) {
    Transfer transfer = zeros(scene);
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (std::size_t c = 0; c < transfer.dimension(); ++c)
                transfer.vector(vertices.first_receiver + v)[c] =
                    light(vertices.positions[v], vertices.normals[v], c);
    return transfer;
}

/// Differs from vertex to vertex as if it were by chance, and across hard edges.
float wild(const glm::vec3& p, const glm::vec3& n, std::size_t column) {
    const float k = 1 + static_cast<float>(column);
    return std::sin(7 * k * p.x + 3) + std::cos(5 * p.y * k + p.z) + 0.5f * std::sin(4 * n.x + 9 * n.y - n.z);
}

/// Returns a box of quads with the normals of its sides; `lean` shears the top, so that edges are not square.
Scene box(const glm::vec3& half, float lean = 0) {
    SceneBuilder builder;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 corners[4];
            for (int i = 0; i < 4; ++i) {
                corners[i][axis] = side;
                corners[i][(axis + 1) % 3] = (i == 1 || i == 2 ? 1.0f : -1.0f) * side;
                corners[i][(axis + 2) % 3] = i > 1 ? 1.0f : -1.0f;
                corners[i] *= half;
                corners[i].x += lean * corners[i].y;
            }
            builder.quad(corners[0], corners[1], corners[2], corners[3]);
        }
    return builder.build();
}

void expect_carried_exactly(const Scene& scene) {
    const LeveledScene levels = leveled(scene, scene);
    const Transfer finest = transfer_of(scene, wild);
    const LevelBake bake = carry_levels(levels, finest, {.threads = 1});
    ASSERT_EQ(bake.levels.size(), 1u);
    EXPECT_LT(bake.levels[0].squares.relative_l2(), 1e-5);
    const std::vector<float> areas = receiver_areas(scene);
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        for (std::size_t c = 0; c < finest.dimension(); ++c) {
            EXPECT_EQ(bake.transfer.vector(p)[c], finest.vector(p)[c]);
            // Positions are rounded to 1e-7 of a few metres, and the light changes by 30 per metre.
            if (areas[p] > 0) {
                EXPECT_NEAR(bake.transfer.vector(scene.receivers() + p)[c], finest.vector(p)[c], 3e-5f) << p;
            }
        }
}

/// Vertices of a level are sealed if the nearest surface of level 0 is.
TEST(Levels, VerticesInsideGeometryAreReported) {
    const Scene scene = test::join(
        {SceneBuilder().floor({0, 0, 0}, 1, 2).build(), SceneBuilder().floor({9, 0, 0}, 1, 2).build()});
    LeveledScene levels = leveled(scene, scene);
    levels.finest_primitives = 2;
    levels.nodes[0].finest = {0, 1};
    levels.nodes[0].coarser[0].primitives = {2, 3};
    std::vector<std::uint32_t> sealed(scene.vertex_arrays[0].size());
    std::iota(sealed.begin(), sealed.end(), 0u);
    const LevelBake bake = carry_levels(levels, zeros(scene), {.sealed = sealed});
    std::vector<std::uint32_t> expected = sealed;
    for (std::uint32_t& receiver : expected)
        receiver += static_cast<std::uint32_t>(scene.receivers());
    EXPECT_EQ(bake.sealed, expected);
    EXPECT_TRUE(carry_levels(levels, zeros(scene)).sealed.empty());
}

TEST(Levels, IdenticalLevelsHaveEqualLight) {
    expect_carried_exactly(SceneBuilder().sphere({0.3f, 0, 0}, 1, 9).build());
    expect_carried_exactly(SceneBuilder().floor({0, 0, 0}, 1, 6).build());
    expect_carried_exactly(box({1, 0.5f, 0.7f}));
    expect_carried_exactly(box({1, 0.5f, 0.7f}, 1.2f));
    expect_carried_exactly(box({1, 0.01f, 1})); // hardly any thickness
}

TEST(Levels, KeepLinearFunctionsOnAPlane) {
    const auto linear = [](const glm::vec3& p, const glm::vec3&, std::size_t c) {
        return 0.3f + 0.2f * static_cast<float>(c) * p.x - 0.1f * p.z;
    };
    const auto shifted = [](const glm::vec3& p) {
        return glm::vec3(p.x + 0.05f * std::sin(9 * p.z) * (1 - p.x * p.x), 0, p.z);
    };
    const Scene fine = SceneBuilder().floor({0, 0, 0}, 1, 23).transform(shifted).build(),
                coarse = SceneBuilder().floor({0, 0, 0}, 1, 3).build();
    const LevelBake bake = carry_levels(leveled(fine, coarse), transfer_of(fine, linear));
    EXPECT_LT(bake.levels[0].squares.relative_l2(), 1e-6);
    for (std::size_t v = 0; v < coarse.receivers(); ++v)
        for (std::size_t c = 0; c < bake.transfer.dimension(); ++c)
            EXPECT_NEAR(bake.transfer.vector(fine.receivers() + v)[c],
                        linear(coarse.vertex_arrays[0].positions[v], {}, c), 2e-6f);
}

/// Bound: the curvature of bands l = 1 and 2 of the cosine lobe, |Y''| <= l (l + 1) |Y|, times R²/2 with R
/// the circumradius of the triangles, is the maximum distance to the nearest linear function; twice that for
/// both meshes.
TEST(Levels, OnAnOpenSphereHaveTheLobesOfTheirNormals) {
    constexpr int kRows = 16, kFineRows = 64, kOrder = 3;
    const Scene fine = SceneBuilder().sphere({0, 0, 0}, 1, kFineRows).build(),
                coarse = SceneBuilder().sphere({0, 0, 0}, 1, kRows).build();
    const LevelBake bake = carry_levels(leveled(fine, coarse), unshadowed_transfer(fine, kOrder));
    const Transfer expected = unshadowed_transfer(coarse, kOrder);
    const double pi = std::numbers::pi, first = 2.0 / 3 * std::sqrt(3 / (4 * pi)) * 2,
                 second = 1.0 / 4 * std::sqrt(5 / (4 * pi)) * 6;
    const auto bound = [&](int rows) {
        const double radius = 0.5 * std::sqrt(2.0) * pi / rows;
        return 0.5 * radius * radius * std::hypot(first, second);
    };
    const std::vector<float> areas = receiver_areas(coarse);
    double error = 0;
    for (std::size_t v = 0; v < coarse.receivers(); ++v) {
        double squared = 0;
        for (std::size_t c = 0; c < expected.dimension(); ++c)
            squared += std::pow(
                static_cast<double>(bake.transfer.vector(fine.receivers() + v)[c] - expected.vector(v)[c]),
                2);
        if (areas[v] > 0)
            error = std::max(error, std::sqrt(squared));
    }
    EXPECT_LT(error, bound(kRows) + bound(kFineRows));
    EXPECT_LT(bake.levels[0].squares.relative_l2(), (bound(kRows) + bound(kFineRows)) / 0.46);
}

/// Compares the nearest point with tests of all triangles, and with points distributed over them.
TEST(Levels, NearestPositionsMatchBruteForce) {
    const Scene scene = test::join(
        {SceneBuilder().sphere({0, 0, 0}, 1, 7).build(), box({0.4f, 0.05f, 2}), box({2, 0.3f, 0.2f}, 0.5f)});
    const TraceScene traced(scene);
    const Receivers receivers = vertex_receivers(scene);
    const NearestPoints points(traced, receivers);
    const auto at = [&](const std::vector<glm::vec3>& values, std::uint32_t t) {
        const glm::uvec3& c = traced.surfaces().corners(t);
        return std::array<glm::dvec3, 3>{glm::dvec3(values[c.x]), glm::dvec3(values[c.y]),
                                         glm::dvec3(values[c.z])};
    };
    std::mt19937 draw(7);
    std::uniform_real_distribution<float> number(-1.5f, 1.5f);
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 position(number(draw), number(draw), number(draw)),
            normal = glm::normalize(glm::vec3(number(draw), number(draw), number(draw)));
        NearestRule rule(points.diagonal());
        rule.begin(position, normal);
        double any = 1e9;
        for (std::uint32_t t = 0; t < traced.surfaces().triangles(); ++t) {
            if (receivers.areas[traced.surfaces().corners(t).x] > 0)
                rule.add(t, at(receivers.positions, t), at(receivers.normals, t));
            const auto corners = at(receivers.positions, t);
            constexpr int kSteps = 24;
            for (int u = 0; u <= kSteps; ++u)
                for (int v = 0; u + v <= kSteps; ++v)
                    any = std::min(any,
                                   glm::distance(glm::dvec3(position),
                                                 corners[0] + (corners[1] - corners[0]) * (u * 1.0 / kSteps) +
                                                     (corners[2] - corners[0]) * (v * 1.0 / kSteps)));
        }
        const NearestPoint expected = rule.result(), found = points.find(position, normal);
        EXPECT_EQ(found.triangle, expected.triangle);
        EXPECT_EQ(found.distance, expected.distance);
        // A twentieth of the diagonal is the weight of a better normal, and points have a distance of 4 / 24.
        EXPECT_LE(found.distance, any + 0.051 * points.diagonal());
        EXPECT_GE(found.distance, any - 0.2);
    }
}

/// The nearest of all is the back of the wall, which looks the other way.
TEST(Levels, UseTheLightOfTheFacingSide) {
    const Scene wall = box({1, 0.01f, 1}), sheet = SceneBuilder().floor({0, -0.012f, 0}, 1, 2).build();
    const auto bright_above = [](const glm::vec3&, const glm::vec3& n, std::size_t) {
        return n.y > 0.5f ? 1.0f : 0.25f;
    };
    const LevelBake bake = carry_levels(leveled(wall, sheet), transfer_of(wall, bright_above));
    for (std::size_t v = 0; v < sheet.receivers(); ++v)
        EXPECT_NEAR(bake.transfer.vector(wall.receivers() + v)[0], 1, 1e-5f);
}

TEST(Levels, DisplacedLevelsAreRejected) {
    const Scene ball = SceneBuilder().sphere({0, 0, 0}, 1, 8).build();
    for (const Scene& level :
         {SceneBuilder().sphere({3, 0, 0}, 1, 6).build(), SceneBuilder().sphere({0, 0, 0}, 4, 6).build()}) {
        const LeveledScene levels = leveled(ball, level);
        EXPECT_THROW(check_levels(levels), Error);
        EXPECT_THROW(carry_levels(levels, zeros(ball)), Error);
    }
    EXPECT_NO_THROW(check_levels(leveled(ball, SceneBuilder().sphere({0, 0, 0}, 0.8f, 4).build())));
}

/// A ball on the ground, and one inside of it.
TEST(Levels, MatchASeparateBake) {
    const Scene ball = SceneBuilder().sphere({0, 1.1f, 0}, 1, 40).build(),
                coarse = SceneBuilder().sphere({0, 1.1f, 0}, 0.97f, 14).build(),
                ground = SceneBuilder().floor({0, 0, 0}, 4, 12).build();
    const LeveledScene levels = leveled(ball, coarse, {ground});
    BakeOptions options;
    options.order = 4;
    options.bounces = 1;
    const Transfer finest = bake(test::join({ball, ground}), options).baked.transfer;
    const LevelBake carried = carry_levels(levels, finest, {.threads = 2}),
                    again = carry_levels(levels, finest, {.threads = 1}),
                    own = bake_levels(levels, finest, options);
    EXPECT_EQ(carried.transfer.vectors, again.transfer.vectors);
    const std::vector<float> areas = areas_of_level(levels, 1);
    const prt::Light sky = overcast_sky(4, glm::vec3(1));
    const double separate =
        lit_rms(exit_radiance(own.transfer, sky), exit_radiance(carried.transfer, sky), areas);
    EXPECT_LT(separate, 0.03);
    EXPECT_LT(carried.levels[0].squares.relative_l2(), own.levels[0].squares.relative_l2());
}

/// Both levels are flat, and measured on a wavy model with the positions of their vertices.
TEST(Levels, AreMeasuredOnAHighPolyModel) {
    const auto floor = [](int cells) { return SceneBuilder().floor({0, 0, 0}, 1, cells).build(); };
    const Scene fine = floor(8), coarse = floor(4),
                detailed = SceneBuilder()
                               .floor({0, 0, 0}, 1, 8)
                               .transform([](const glm::vec3&p) {
                                   return p + glm::vec3(0, 0.2f * std::cos(4 * p.x), 0);
                               })
                               .build();
    const LeveledScene levels = leveled(fine, coarse);
    BakeOptions options;
    options.order = 3;
    options.rays = 1024;
    options.repairs.denoise = false;
    const FinerModel finer{&detailed, 0.5};
    const Transfer finest = bake(fine, options, {}, MeasureErrors::no, finer).baked.transfer,
                   truth = bake(detailed, options).baked.transfer,
                   own = bake_levels(levels, finest, options, {}, finer).transfer,
                   carried = carry_levels(levels, finest).transfer;
    std::size_t same = 0;
    for (std::size_t v = 0; v < coarse.receivers(); ++v)
        for (std::size_t d = 0; d < detailed.receivers(); ++d) {
            const glm::vec3 &here = coarse.vertex_arrays[0].positions[v],
                            &there = detailed.vertex_arrays[0].positions[d];
            if (glm::distance(glm::vec2(here.x, here.z), glm::vec2(there.x, there.z)) > 1e-5f)
                continue;
            ++same;
            EXPECT_NEAR(own.vector(fine.receivers() + v)[0], truth.vector(d)[0], 0.01f) << v;
            EXPECT_NEAR(carried.vector(fine.receivers() + v)[0], truth.vector(d)[0], 0.06f) << v;
        }
    EXPECT_GE(same, coarse.receivers());
}

} // namespace levels_of_detail
} // namespace prt
