// Tests vertices that are measured on a detailed model: a closed form, and bakes of that model itself.

#include "bake/scene/receivers.h"
#include "prt/bake/bake.h"
#include "prt/bake/refine.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "prt/gltf/refinement.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace prt {
namespace high_poly {

using test::SceneBuilder;

constexpr double kReach = 0.5;
/// Rays that graze a neighbouring triangle are blocked from one origin only: some of 64 rays.
constexpr double kSameRays = 0.04;

BakeOptions options_of(int bounces, int rays = 64) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.bounces = bounces;
    options.tracer.backend = Backend::cpu;
    options.repairs.denoise = false;
    return options;
}

/// Two metres of floor in colored cells.
Scene floor_of(int cells) {
    return test::painted(SceneBuilder().floor({0, 0, 0}, 1, cells).build(), {0.8f, 0.5f, 0.3f});
}

/// The floor with waves, with the normals of the waves, elsewhere in the frame of its file.
Scene waves(Scene floor) {
    constexpr float kHeight = 0.2f, kPerMetre = 4;
    VertexArray& vertices = floor.vertex_arrays[0];
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        glm::vec3& p = vertices.positions[v];
        const float slope = -kHeight * kPerMetre * std::sin(kPerMetre * p.x);
        vertices.normals[v] = glm::normalize(glm::vec3(-slope, 1, 0));
        p.y += kHeight * std::cos(kPerMetre * p.x);
    }
    return floor;
}

/// `surface` under a ball, which the scenes of the tests do not contain.
Scene under_a_ball(const Scene& surface) {
    return test::join({surface, test::painted(SceneBuilder().sphere({0.3f, 1.3f, 0.2f}, 0.6f, 6).build(),
                                              {0.2f, 0.9f, 0.4f})});
}

/// Transfer of the first `count` receivers.
Transfer first_of(Transfer transfer, std::size_t count) {
    transfer.vectors.resize(count * transfer.dimension());
    return transfer;
}

/// Relative L2 difference between the vertices of `scene` measured on `detailed` and the first vertices of a
/// bake of `detailed` itself. Both have the same rays, from origins that differ by surface offsets.
double difference(const Scene& scene, const Scene& detailed, const BakeOptions& options) {
    const Transfer baked = bake(scene, options, {}, MeasureErrors::no, {&detailed, kReach}).baked.transfer,
                   truth = first_of(bake(detailed, options).baked.transfer, scene.receivers());
    EXPECT_TRUE(baked.layout == truth.layout);
    return relative_l2(truth, baked, receiver_areas(scene));
}

/// A floor for a pit with a long wall at its edge: the wall hides (1 - cos) / 2 of a uniform sky.
TEST(HighPoly, VerticesHaveTheVisibilityOfTheDetailedSurface) {
    constexpr float kFar = 1000, kTop = 0.5f, kDepth = 0.2f;
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 1, 4).build();
    Scene pit = test::join(
        {SceneBuilder().floor({0, -kDepth, 0}, 1.05f).build(),
         SceneBuilder()
             .quad({-1.1f, -kDepth, kFar}, {-1.1f, -kDepth, -kFar}, {-1.1f, kTop, -kFar}, {-1.1f, kTop, kFar})
             .build()});
    pit.origin = {0, 5, 0}; // both are at one position in the world
    for (VertexArray& vertices : pit.vertex_arrays)
        for (glm::vec3& p : vertices.positions)
            p.y -= 5;
    const auto open = [&](double reach, double wall) {
        const Transfer baked =
            bake(floor, options_of(0, 4096), {}, MeasureErrors::no, {&pit, reach}).baked.transfer;
        for (std::size_t v = 0; v < floor.receivers(); ++v) {
            const double away = static_cast<double>(floor.vertex_arrays[0].positions[v].x) + 1.1,
                         expected = 0.5 + 0.5 * away / std::hypot(away, wall);
            EXPECT_NEAR(static_cast<double>(baked.vector(v)[0]) / kY00, expected, 0.01) << v;
        }
    };
    open(0.3, 0.7);
    EXPECT_THROW(open(0.1, 0.5), Error); // no vertex finds the pit
}

TEST(HighPoly, BacksOfDoubleSidedSurfacesAreFound) {
    const Scene floor = floor_of(8), up = under_a_ball(waves(floor_of(8)));
    Scene down = up;
    for (glm::uvec3& t : down.primitives[0].triangles)
        std::swap(t.y, t.z);
    for (glm::vec3& normal : down.vertex_arrays[0].normals)
        normal = -normal;
    down.materials[down.primitives[0].material].double_sided = true;
    const Transfer truth = first_of(bake(up, options_of(0)).baked.transfer, floor.receivers()),
                   baked = bake(floor, options_of(0), {}, MeasureErrors::no, {&down, kReach}).baked.transfer;
    EXPECT_LT(relative_l2(truth, baked, receiver_areas(floor)), kSameRays);
}

TEST(HighPoly, VerticesWithoutADetailedSurfaceKeepTheirPosition) {
    const Scene floor = floor_of(4), half = waves(floor_of(4));
    Scene detailed = half;
    std::erase_if(detailed.primitives[0].triangles, [&](const glm::uvec3& t) {
        return half.vertex_arrays[0].positions[t.x].x >= 0 || half.vertex_arrays[0].positions[t.y].x > 0 ||
               half.vertex_arrays[0].positions[t.z].x > 0;
    });
    const BakeResult result = bake(floor, options_of(0), {}, MeasureErrors::no, {&detailed, kReach});
    EXPECT_EQ(std::ranges::count_if(result.statistics.notices,
                                    [](const std::string& n) { return n.find("low-poly") != n.npos; }),
              1);
    const Transfer flat = unshadowed_transfer(floor, 3);
    for (std::size_t v = 0; v < floor.receivers(); ++v)
        if (floor.vertex_arrays[0].positions[v].x > 0.9f) {
            EXPECT_NEAR(result.baked.transfer.vector(v)[0], flat.vector(v)[0], 0.02f) << v;
        }
}

TEST(HighPoly, BouncesAreThoseOfTheDetailedModel) {
    const Scene floor = floor_of(6), detailed = under_a_ball(waves(floor));
    for (const int bounces : {0, 1, 3, kEndlessBounces})
        EXPECT_LT(difference(floor, detailed, options_of(bounces)), kSameRays) << bounces;
    BakeOptions options = options_of(1);
    options.target_error = 0.1;
    EXPECT_LT(difference(floor, detailed, options), 0.1);
    const Transfer plain = bake(floor, options_of(0)).baked.transfer,
                   truth = first_of(bake(detailed, options_of(0)).baked.transfer, floor.receivers());
    EXPECT_GT(relative_l2(truth, plain, receiver_areas(floor)), 0.2); // what the tests would miss
}

/// Lamps of the detailed model: a light, and an emissive ball of another color than grey surfaces.
TEST(HighPoly, LampsAreThoseOfTheDetailedModel) {
    for (const glm::vec3& color : {glm::vec3(0.6f), glm::vec3(0.8f, 0.5f, 0.3f)}) {
        const Scene floor = test::painted(floor_of(4), color);
        Scene detailed =
            test::join({waves(floor), test::painted(SceneBuilder().sphere({0, 1.2f, 0}, 0.3f, 4).build(),
                                                    glm::vec3(0.5f))});
        detailed.materials[1].emission.radiance = {3, 2, 1};
        detailed.materials[1].name = "glow";
        detailed.lights.push_back(test::lamp_at({0.5f, 2, 0.5f}));
        for (const int bounces : {0, 2})
            for (const LampMode mode : {LampMode::all, LampMode::indirect}) {
                BakeOptions options = options_of(bounces);
                options.lamps.mode = mode;
                EXPECT_LT(difference(floor, detailed, options), kSameRays) << bounces;
            }
    }
}

TEST(HighPoly, SheetsHaveLightOfBothSidesOfTheDetailedModel) {
    Scene leaf = test::painted(floor_of(6), {0.8f, 0.4f, 0.2f}, true);
    leaf.materials[0].transmission.factor = 0.4f;
    leaf.materials[0].transmission.color = {0.5f, 1, 1};
    const Scene detailed = under_a_ball(waves(leaf));
    for (const int bounces : {0, 2}) // the rays of the backs differ
        EXPECT_LT(difference(leaf, detailed, options_of(bounces, 1024)), 0.03) << bounces;
}

/// Light scatters in the shape of the scene, and arrives at the detailed surface: both have one shape here.
TEST(HighPoly, MediaScatterTheLightOfTheDetailedModel) {
    Scene floor = test::join({floor_of(6), SceneBuilder().floor({3, 0, 0}, 1, 2).build()});
    floor.materials[0].name = "milk";
    Scene lower = floor;
    for (VertexArray& vertices : lower.vertex_arrays)
        for (glm::vec3& p : vertices.positions)
            p.y -= 0.3f;
    BakeOptions options = options_of(1);
    options.subsurface.media = {{"milk", {glm::dvec3(20, 30, 40), glm::dvec3(0.5), 1.3}}};
    EXPECT_LT(difference(floor, under_a_ball(lower), options), 1e-3);
    Scene stone = under_a_ball(lower);
    stone.materials[0].name = "stone"; // the medium of the scene alone
    EXPECT_NO_THROW(bake(floor, options, {}, MeasureErrors::no, {&stone, kReach}));
    options.subsurface.media[0].material = "water";
    EXPECT_THROW(bake(floor, options, {}, MeasureErrors::no, {&stone, kReach}), Error);
}

/// Samples have other positions on the flat floor than on the waves, and other rays.
TEST(HighPoly, SurfaceFitMeasuresOnTheDetailedModel) {
    const Scene floor = floor_of(5), detailed = under_a_ball(waves(floor));
    for (const int bounces : {0, 1}) {
        BakeOptions options = options_of(bounces, 1024);
        options.fit = FitMode::surface;
        options.lamps.mode = LampMode::all;
        Scene lit = detailed;
        lit.lights.push_back(test::lamp_at({0.5f, 2, 0.5f}));
        EXPECT_LT(difference(floor, lit, options), 0.06) << bounces;
    }
}

TEST(HighPoly, NoiseFilterAndErrorsUseTheDetailedModel) {
    const Scene floor = floor_of(6), detailed = under_a_ball(waves(floor));
    BakeOptions options = options_of(1, 256);
    options.repairs.denoise = true;
    EXPECT_LT(difference(floor, detailed, options), 0.05);
    const auto error = [&](const Scene& surface, const FinerModel& finer) {
        return bake(surface, options, {}, MeasureErrors::yes, finer).errors->nodes.front().sky.relative_l2;
    };
    const double expected = error(detailed, {});
    EXPECT_NEAR(error(floor, {&detailed, kReach}), expected, 0.3 * expected);
}

/// Two triangles under the floor of the detailed model are split at its wall.
TEST(HighPoly, RefinementFollowsTheLightOfTheDetailedModel) {
    const Scene floor = SceneBuilder().floor({0, 0, 0}, 4).build(),
                detailed = test::join({SceneBuilder().floor({0, 0.1f, 0}, 4).build(),
                                       SceneBuilder()
                                           .quad({1, 0.1f, -4}, {1, 0.1f, 4}, {1, 2, 4}, {1, 2, -4})
                                           .quad({1, 0.1f, 4}, {1, 0.1f, -4}, {1, 2, -4}, {1, 2, 4})
                                           .build()});
    const FinerModel finer{&detailed, kReach};
    BakeOptions options = options_of(0, 512);
    options.fit = FitMode::surface;
    const RefineResult result = refine(floor, options, {.target = 0.1}, {}, finer);
    EXPECT_GT(result.statistics.rounds, 0);
    EXPECT_LE(result.statistics.after.error, 0.1);
    const Scene split = refined(floor, result.refinement);
    const BakeResult baked = bake(split, options, {}, MeasureErrors::yes, finer);
    EXPECT_LT(baked.errors->sky.relative_l2, 0.14);
    EXPECT_GT(bake(floor, options, {}, MeasureErrors::yes, finer).errors->sky.relative_l2, 0.2);
}

} // namespace high_poly
} // namespace prt
