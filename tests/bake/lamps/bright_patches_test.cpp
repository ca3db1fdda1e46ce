// Connections to patches that lamps light.

#include "bake/pipeline/bright_patches.h"
#include "prt/bake/bake.h"
#include "prt/core/error_measures.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;
using test::SceneBuilder;

/// A floor of 0.5 m cells, a ball, and a wall that faces away.
Scene room() {
    Scene scene =
        test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 8).build(),
                                  SceneBuilder().sphere({0.5f, 1, 0.5f}, 0.4f, 8).build(),
                                  SceneBuilder().quad({-2, 0, 2}, {2, 0, 2}, {2, 1, 2}, {-2, 1, 2}).build()}),
                      glm::vec3(0.5f));
    scene.lights = {test::lamp_at({0, 2, 0})};
    return scene;
}

/// Patches of a scene with unevenly lit receivers.
class Patches {
public:
    explicit Patches(Scene scene, bool lit = true) : scene_(std::move(scene)) {
        Transfer light = zero_transfer(1, 1, plan_.receivers().size());
        for (std::uint32_t p = 0; lit && p < light.receivers(); ++p)
            light.vector(p)[0] = 0.1f + static_cast<float>(p % 7);
        patches.emplace(plan_, light);
    }
    std::uint32_t triangles() const { return static_cast<std::uint32_t>(traced_.surfaces().triangles()); }
    double area(std::uint32_t t) const {
        const auto [a, b, c] = patches->corners(t);
        return 0.5 * glm::length(glm::cross(b - a, c - a));
    }

private:
    Scene scene_;
    BakeOptions options_ = [] {
        BakeOptions options;
        options.bounces = 1;
        return options;
    }();
    TraceScene traced_{scene_};
    Media media_ = Media(scene_.materials.size());
    BakePlan plan_ = plan_bake(traced_, media_, options_);

public:
    std::optional<BrightPatches> patches;
};

/// Probabilities of all patches add up to 1, and `pick` follows them.
TEST(BrightPatches, SampleTheStatedDensity) {
    const Patches all(room());
    for (const auto& [position, normal] :
         {std::pair(glm::dvec3(0, 0.001, 0), glm::dvec3(0, 1, 0)),
          std::pair(glm::dvec3(1, 2, 0), glm::dvec3(0, -1, 0)),
          std::pair(glm::dvec3(-1.9, 0.5, 0.3), glm::normalize(glm::dvec3(1, 0.3, 0.1)))}) {
        const BrightPatches::Receiver receiver{position, normal};
        double sum = 0;
        for (std::uint32_t t = 0; t < all.triangles(); ++t) {
            sum += all.patches->density(receiver, t, false) * all.area(t);
            EXPECT_EQ(all.patches->density(receiver, t, true), 0); // backs are dark
        }
        EXPECT_NEAR(sum, 1, 1e-9);
        constexpr int kPicks = 40000;
        std::map<std::uint32_t, int> picked;
        for (int i = 0; i < kPicks; ++i) {
            const auto point = all.patches->pick(receiver, (i + 0.5) / kPicks, {0.2, 0.3});
            ASSERT_TRUE(point);
            ASSERT_NEAR(point->density, all.patches->density(receiver, point->triangle, false),
                        1e-9 * point->density);
            ++picked[point->triangle];
        }
        for (std::uint32_t t = 0; t < all.triangles(); ++t) // choices are even, each triangle has an interval
            EXPECT_NEAR(picked[t], kPicks * all.patches->density(receiver, t, false) * all.area(t), 1.01)
                << t;
    }
}

/// A patch in the plane of a receiver does not light it, and is omitted unless other patches are near.
TEST(BrightPatches, ExcludeTheReceiversPlane) {
    const Patches all(test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 40).build(),
                                                SceneBuilder().sphere({0.5f, 1, 0.5f}, 0.4f, 16).build()}),
                                    glm::vec3(0.5f)));
    const BrightPatches::Receiver on_floor{glm::dvec3(0.31, 0, -0.72), glm::dvec3(0, 1, 0)};
    double in_plane = 0;
    for (std::uint32_t t = 0; t < all.triangles(); ++t) {
        const auto [a, b, c] = all.patches->corners(t);
        if (a.y == 0 && b.y == 0 && c.y == 0)
            in_plane += all.patches->density(on_floor, t, false) * all.area(t);
    }
    EXPECT_LT(in_plane, 0.05);
}

/// A panel of 20 cm, lit by a lamp close under it, lights a floor 2 m below: one ray in three hundred meets
/// it.
Scene small_panel(bool sheet_between) {
    SceneBuilder panel;
    constexpr int kCells = 24;
    constexpr float kSize = 0.2f;
    for (int i = 0; i < kCells; ++i)
        for (int j = 0; j < kCells; ++j) {
            const float cell = kSize / kCells, x = -0.5f * kSize + cell * static_cast<float>(i),
                        z = -0.5f * kSize + cell * static_cast<float>(j);
            panel.quad({x, 2, z}, {x + cell, 2, z}, {x + cell, 2, z + cell}, {x, 2, z + cell});
        }
    std::vector<Scene> terms{panel.build(), SceneBuilder().floor({0, 0, 0}, 0.5f, 4).build()};
    if (sheet_between)
        terms.push_back(SceneBuilder().floor({0, 1, 0}, 5).build());
    Scene scene = test::painted(test::join(terms), glm::vec3(0.6f));
    PunctualLight spot = test::lamp_at({0, 1.85f, 0});
    spot.kind = PunctualKind::spot;
    spot.direction = {0, 1, 0};
    spot.inner_cone = 1.2f;
    spot.outer_cone = 1.3f;
    scene.lights = {spot};
    return scene;
}

/// Bounced light of the first lamp at the receivers of the floor.
std::vector<float> on_floor(const Scene& scene, std::uint64_t seed, FitMode fit) {
    BakeOptions options;
    options.order = 1;
    options.rays = 256;
    options.bounces = 1;
    options.seed = seed;
    options.fit = fit;
    options.repairs.denoise = false;
    options.lamps.mode = LampMode::indirect;
    options.tracer.backend = Backend::cpu;
    const Transfer light = bake(scene, options).baked.transfer;
    std::vector<float> values;
    const std::size_t first = scene.vertex_arrays[0].positions.size(),
                      count = scene.vertex_arrays[1].positions.size();
    for (std::size_t v = first; v < first + count; ++v)
        values.push_back(light.vector(static_cast<std::uint32_t>(v)).back());
    return values;
}

/// By the form factors of small squares of the panel.
double expected_at(const glm::dvec3& position) {
    constexpr int kSquares = 200;
    double sum = 0;
    for (int i = 0; i < kSquares; ++i)
        for (int j = 0; j < kSquares; ++j) {
            const glm::dvec3 at(0.2 * ((i + 0.5) / kSquares - 0.5), 2, 0.2 * ((j + 0.5) / kSquares - 0.5));
            const glm::dvec3 to_lamp = glm::dvec3(0, static_cast<double>(1.85f), 0) - at,
                             down = position - at;
            const double d = glm::length(to_lamp), r = glm::length(down),
                         irradiance = -to_lamp.y / (d * d * d), cosine = -down.y / r;
            sum += 0.6 * irradiance / pi * cosine * cosine / (pi * r * r);
        }
    return sum * 0.2 * 0.2 / (kSquares * kSquares);
}

TEST(BrightPatches, GatherTheLightOfASmallPanel) {
    const Scene scene = small_panel(false);
    for (const FitMode fit : {FitMode::vertex, FitMode::surface}) {
        constexpr int kSeeds = 8;
        std::vector<double> mean(scene.vertex_arrays[1].positions.size());
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
            const std::vector<float> values = on_floor(scene, seed, fit);
            for (std::size_t v = 0; v < values.size(); ++v)
                mean[v] += static_cast<double>(values[v]) / kSeeds;
        }
        for (std::size_t v = 0; v < mean.size(); ++v) {
            const double expected = expected_at(glm::dvec3(scene.vertex_arrays[1].positions[v]));
            // A fit knows the floor between its vertices, too.
            EXPECT_NEAR(mean[v], expected, (fit == FitMode::vertex ? 0.01 : 0.02) * expected);
        }
    }
    // One bake: hemisphere rays alone are off by 60 %.
    const std::vector<float> once = on_floor(scene, 3, FitMode::vertex);
    for (std::size_t v = 0; v < once.size(); ++v) {
        const double expected = expected_at(glm::dvec3(scene.vertex_arrays[1].positions[v]));
        EXPECT_NEAR(static_cast<double>(once[v]), expected, 0.1 * expected);
    }
}

TEST(BrightPatches, DoNotLightThroughASheet) {
    for (const float value : on_floor(small_panel(true), 1, FitMode::vertex))
        EXPECT_EQ(value, 0);
}

TEST(BrightPatches, AreEmptyWithoutLight) {
    const Patches dark(room(), false);
    EXPECT_TRUE(dark.patches->empty());
    const BrightPatches::Receiver receiver{glm::dvec3(0), glm::dvec3(0, 1, 0)};
    EXPECT_FALSE(dark.patches->pick(receiver, 0.5, {0.2, 0.2}));
    EXPECT_EQ(dark.patches->density(receiver, 0, false), 0);
    EXPECT_FALSE(Patches(room()).patches->empty());
}

} // namespace
} // namespace prt
