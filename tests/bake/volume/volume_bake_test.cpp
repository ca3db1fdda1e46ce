// Probes against closed forms: the open, a half space, a furnace, walls, lamps.

#include "bake/reference/incident_reference.h"
#include "prt/bake/volume_bake.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "prt/core/transfer.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using test::SceneBuilder;

BakeOptions rays(int count, int bounces = 0) {
    BakeOptions options;
    options.order = 4;
    options.rays = count;
    options.bounces = bounces;
    options.tracer.backend = Backend::cpu;
    return options;
}

VolumeOptions probes(double spacing, const Bounds& bounds) {
    return {.spacing = spacing, .bounds = bounds, .fit_points = 0};
}

/// Walls of a box that face inwards; `open` walls, by number, are left out: -x, +x, -y, +y, -z, +z.
SceneBuilder& add_box(SceneBuilder& builder, const glm::vec3& low, const glm::vec3& high, int cells,
                      int open = -1) {
    for (int wall = 0; wall < 6; ++wall) {
        if (wall == open)
            continue;
        const int axis = wall / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        glm::vec3 corner = low, du(0), dv(0);
        corner[axis] = wall % 2 == 0 ? low[axis] : high[axis];
        du[u] = (high[u] - low[u]) / static_cast<float>(cells);
        dv[v] = (high[v] - low[v]) / static_cast<float>(cells);
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j) {
                const glm::vec3 a = corner + static_cast<float>(i) * du + static_cast<float>(j) * dv;
                if (wall % 2 == 0)
                    builder.quad(a, a + du, a + du + dv, a + dv);
                else
                    builder.quad(a, a + dv, a + du + dv, a + du);
            }
    }
    return builder;
}

TEST(VolumeBake, IsTheIdentityWithoutOcclusion) {
    const Scene scene = SceneBuilder().floor({0, -1e6f, 0}, 0.1f).build();
    const VolumeBake bake = bake_volume(scene, probes(1, {{0, 0, 0}, {4, 4, 4}}), rays(64));
    const Transfer& t = bake.volume.baked.transfer;
    ASSERT_EQ(t.receivers(), 125u * 9);
    for (std::size_t r = 0; r < t.receivers(); ++r)
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ(t.vector(r)[i], i == r % 9 ? 1.0f : 0.0f);
    for (const ProbeVisibility& visibility : bake.volume.visibility)
        for (const std::uint8_t s : visibility)
            EXPECT_GT(s, 180); // beyond two cells
}

/// Integral of Y_o Y_i over the upper half, by a product rule.
double half_product(std::size_t o, std::size_t i) {
    double sum = 0;
    std::array<double, 16> basis{};
    constexpr int kZ = 64, kTurn = 64;
    for (int a = 0; a < kZ; ++a)
        for (int b = 0; b < kTurn; ++b) {
            const double y = (a + 0.5) / kZ, rotation = 2 * std::numbers::pi * b / kTurn,
                         r = std::sqrt(1 - y * y);
            evaluate_sh(4, glm::dvec3(r * std::cos(rotation), y, r * std::sin(rotation)), basis);
            sum += basis[o] * basis[i] * 2 * std::numbers::pi / (kZ * kTurn);
        }
    return sum;
}

TEST(VolumeBake, OverABlackFloorIsHalfOfTheIdentity) {
    // Hits are barycentric coordinates: floats resolve positions on the floor to a few millionths of its
    // size. Processors round them differently, which was 12 % of a direction a centimetre above 10 km of
    // floor.
    const Scene scene = test::painted(SceneBuilder().floor({0, 0, 0}, 1e3f).build(), glm::vec3(0));
    const std::vector<glm::vec3> positions = {{0, 0.5f, 0}, {1, 0.01f, 2}, {-3, 2, 1}};
    const PlacedLight light = bake_positions(scene, positions, 3, rays(6 * 4096));
    for (std::size_t r = 0; r < 27; ++r)
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_NEAR(light.transfer.vector(r)[i], half_product(r % 9, i), 4e-3) << r << " " << i;
}

/// Probes have the same rays in all bakes: they differ only by the noise of the light that surfaces reflect.
TEST(VolumeBake, ReceivesLightOfSurfacesWithATargetError) {
    SceneBuilder box;
    add_box(box, {-1, -1, -1}, {1, 1, 1}, 4, 3); // open above
    const Scene scene = test::painted(box.build(), glm::vec3(0.8f));
    VolumeOptions volume = probes(0.8, {{-0.9f, -0.9f, -0.9f}, {0.9f, 0.9f, 0.9f}});
    volume.rays = 6 * 64;
    const auto baked = [&](int count, std::optional<double> target) {
        BakeOptions options = rays(count, 2);
        options.repairs.denoise = false;
        options.target_error = target;
        return bake_volume(scene, volume, options);
    };
    const VolumeBake reference = baked(1 << 13, {}), noisy = baked(16, {});
    const std::vector<float> same(reference.volume.baked.transfer.receivers(), 1.0f);
    const auto error = [&](const VolumeBake& bake) {
        return relative_l2(reference.volume.baked.transfer, bake.volume.baked.transfer, same);
    };
    constexpr double kTarget = 0.01;
    const VolumeBake loose = baked(16, 1.0), fine = baked(16, kTarget);
    EXPECT_LT(error(fine), 0.5 * error(noisy));
    EXPECT_LT(error(fine), kTarget); // probes see means over surfaces
    EXPECT_GT(error(loose), error(fine));
    EXPECT_EQ(fine.volume.baked.record.rays, volume.rays);
}

TEST(VolumeBake, IsOneInAWhiteFurnace) {
    SceneBuilder box;
    add_box(box, {-1, -1, -1}, {1, 1, 1}, 6, 3); // open above
    const Scene scene = test::painted(box.build(), glm::vec3(1));
    const VolumeBake bake = bake_volume(scene, probes(0.4, {{-0.9f, -0.9f, -0.9f}, {0.9f, 0.9f, 0.9f}}),
                                        rays(6 * 256, kEndlessBounces));
    const Light sky = constant_light(4, glm::vec3(1));
    const std::vector<glm::vec3> light = exit_radiance(bake.volume.baked.transfer, sky);
    const VolumeProbes probes_there = probes_of(bake.volume.grid);
    double error = 0;
    for (std::size_t r = 0; r < light.size(); ++r) {
        const glm::vec3 at = position_of(bake.volume.grid, probes_there.corners[r / 9]);
        if (std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > 0.99f) // outside
            continue;
        const double expected = r % 9 == 0 ? std::sqrt(4 * std::numbers::pi) : 0;
        error = std::max(error, std::abs(static_cast<double>(light[r].x) - expected));
    }
    EXPECT_LT(error, 0.08); // out of 3.54: rays are as even over the sphere as 1 536 are
}

TEST(VolumeBake, LightDoesNotComeThroughAThinWall) {
    // A room that is open to the sky, and next to it a closed one, with one sheet between them.
    SceneBuilder lit, dark;
    add_box(lit, {-2, -1, -1}, {0, 1, 1}, 4, 3);
    add_box(dark, {0, -1, -1}, {2, 1, 1}, 4);
    const Scene scene = test::painted(test::join({lit.build(), dark.build()}), glm::vec3(0.7f));
    VolumeOptions volume = probes(0.5, {{-2, -1, -1}, {2, 1, 1}});
    for (const double fit : {0.0, 1.0}) {
        volume.fit_points = fit;
        const VolumeBake bake = bake_volume(scene, volume, rays(6 * 64, 3));
        const std::vector<glm::vec3> at_probes =
            exit_radiance(bake.volume.baked.transfer, constant_light(4, glm::vec3(1)));
        const VolumeLookup lookup(bake.volume.grid, bake.volume.visibility);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(-0.97f, 0.97f);
        double of_lit = 0, of_dark = 0;
        std::array<glm::vec3, 9> light;
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 point(1 + unit(random), unit(random), unit(random));
            mix_incident(lookup.find(point), at_probes, light);
            of_dark += static_cast<double>(glm::length(light[0]));
            mix_incident(lookup.find(point - glm::vec3(2, 0, 0)), at_probes, light);
            of_lit += static_cast<double>(glm::length(light[0]));
        }
        EXPECT_GT(of_lit / 2000, 1);
        EXPECT_LT(of_dark, 0.002 * of_lit) << fit;
    }
}

TEST(VolumeBake, FitReducesTheErrorBetweenProbes) {
    SceneBuilder box;
    add_box(box, {-2, -1, -1}, {2, 1, 1}, 8, 0);
    const Scene scene = test::painted(box.build(), glm::vec3(0.6f));
    std::mt19937 random(9);
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 300; ++i)
        positions.emplace_back(1.9f * (2 * static_cast<float>(random()) * 0x1p-32f - 1),
                               0.9f * (2 * static_cast<float>(random()) * 0x1p-32f - 1),
                               0.9f * (2 * static_cast<float>(random()) * 0x1p-32f - 1));
    const PlacedLight truth = bake_positions(scene, positions, 3, rays(6 * 512, 2));
    const auto error = [&](double fit) {
        VolumeOptions volume = probes(0.7, {{-2, -1, -1}, {2, 1, 1}});
        volume.fit_points = fit;
        const VolumeBake bake = bake_volume(scene, volume, rays(6 * 1024, 2)); // noise is not tested
        const VolumeLookup lookup(bake.volume.grid, bake.volume.visibility);
        const Transfer& t = bake.volume.baked.transfer;
        double sum = 0;
        for (std::size_t p = 0; p < positions.size(); ++p) {
            const VolumeCorners corners = lookup.find(positions[p]);
            for (std::size_t o = 0; o < 9; ++o)
                for (std::size_t i = 0; i < t.dimension(); ++i) {
                    float mixed = 0;
                    for (std::size_t c = 0; c < 8; ++c)
                        mixed += corners.weights[c] * t.vector(corners.probes[c] * 9 + o)[i];
                    const double off = static_cast<double>(mixed - truth.transfer.vector(p * 9 + o)[i]);
                    sum += off * off;
                }
        }
        return std::sqrt(sum);
    };
    EXPECT_LT(error(4), 0.95 * error(0));
}

TEST(VolumeBake, PointLampsLightFromTheirPositions) {
    Scene scene = SceneBuilder().floor({0, -50, 0}, 1).build();
    scene.lights.push_back({.name = "lamp", .intensity = {4, 2, 1}, .position = {3, 0, 0}});
    const std::vector<glm::vec3> positions = {{1, 0, 0}, {3, 2, 0}, {0, 0, 4}};
    const PlacedLight light = bake_positions(scene, positions, 3, rays(32));
    for (std::size_t p = 0; p < positions.size(); ++p) {
        const glm::vec3 way = glm::vec3(3, 0, 0) - positions[p];
        const float d2 = glm::dot(way, way);
        std::array<float, 9> basis{};
        evaluate_sh(3, glm::normalize(way), basis);
        Lighting lighting{constant_light(4, glm::vec3(0))};
        lighting.lamps = {glm::vec3(1)};
        const std::vector<glm::vec3> incident = exit_radiance(light.transfer, lighting);
        for (std::size_t o = 0; o < 9; ++o)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(incident[p * 9 + o][c], basis[o] * scene.lights[0].intensity[c] / d2, 1e-4f);
    }
}

TEST(VolumeBake, DoesNotDependOnThreads) {
    SceneBuilder box;
    add_box(box, {-1, -1, -1}, {1, 1, 1}, 3, 3);
    const Scene scene = test::painted(box.build(), {0.8f, 0.5f, 0.2f});
    VolumeOptions volume = probes(0.3, {{-1, -1, -1}, {1, 1, 1}});
    volume.fit_points = 1;
    BakeOptions options = rays(100, 2);
    options.threads = 1;
    const VolumeBake one = bake_volume(scene, volume, options);
    options.threads = 3;
    const VolumeBake three = bake_volume(scene, volume, options);
    EXPECT_EQ(one.volume.grid, three.volume.grid);
    EXPECT_EQ(one.volume.visibility, three.volume.visibility);
    EXPECT_EQ(one.volume.baked.transfer.vectors, three.volume.baked.transfer.vectors);
}

TEST(VolumeBake, UsesCoarseBricksInOpenSpace) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    const VolumeBake bake = bake_volume(scene, probes(0.25, {{-4, -1, -4}, {4, 7, 4}}), rays(16));
    int finest = 0, coarsest = 0;
    for (const VolumeBrick& brick : bake.volume.grid.bricks) {
        finest += brick.level == 0;
        coarsest += brick.level >= 2;
    }
    EXPECT_GT(finest, 0);
    EXPECT_GT(coarsest, 0);
    EXPECT_LT(bake.volume.grid.bricks.size(), 512u / 2);
    EXPECT_GT(bake.statistics.probes.hanging, 0u);
}

TEST(VolumeBake, KeepsTheProbeLimit) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    for (const std::size_t most : {125u, 1000u, 5000u}) {
        const VolumeOptions volume{
            .probes = most, .bounds = Bounds{{-4, -1, -4}, {4, 3, 4}}, .fit_points = 0};
        const std::size_t got = bake_volume(scene, volume, rays(8)).volume.visibility.size();
        EXPECT_LE(got, most);
        EXPECT_GE(got, most / 4);
    }
}

TEST(VolumeBake, RejectsInvalidVolumes) {
    const Scene scene = SceneBuilder().floor({0, 0, 0}, 1).build();
    const Bounds box{{-1, 0, -1}, {1, 1, 1}};
    EXPECT_THROW(bake_volume(scene, probes(0, box), rays(8)), Error);
    EXPECT_THROW(bake_volume(scene, probes(-1, box), rays(8)), Error);
    EXPECT_THROW(bake_volume(scene, probes(1e-7, box), rays(8)), Error);
    EXPECT_THROW(bake_volume(scene, probes(1, {{1, 0, 0}, {-1, 1, 1}}), rays(8)), Error);
    VolumeOptions orders = probes(1, box);
    orders.order = 5;
    EXPECT_THROW(bake_volume(scene, orders, rays(8)), Error);
    const Scene solid = SceneBuilder().sphere({0, 0, 0}, 2, 12).build(); // all probes are inside
    EXPECT_THROW(bake_volume(solid, probes(0.5, {{-0.8f, -0.8f, -0.8f}, {0.8f, 0.8f, 0.8f}}), rays(60)),
                 Error);
}

// Paths share neither code nor samples with the bake.
TEST(IncidentReference, MatchesABakeWithManyRays) {
    SceneBuilder box;
    add_box(box, {-1, -1, -1}, {1, 1, 1}, 8, 3);
    const Scene scene = test::painted(box.build(), {0.7f, 0.5f, 0.3f});
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {0.5f, -0.5f, 0.2f}, {-0.7f, 0.6f, -0.6f}};
    const Light sky = constant_light(4, glm::vec3(1));
    const PlacedLight baked = bake_positions(scene, positions, 3, rays(6 * 2048, kEndlessBounces));
    const std::vector<glm::vec3> expected = exit_radiance(baked.transfer, sky);
    const Image white{8, 4, std::vector<glm::vec3>(32, glm::vec3(1))};
    const ReferenceLight light{.all = DistantLight(white),
                               .sky = std::nullopt,
                               .suns = {},
                               .sky_bands = constant_light(kMaxOrder, glm::vec3(1)),
                               .sun_bands = constant_light(kMaxOrder, glm::vec3(0))};
    const TraceScene traced(scene);
    const auto halves = incident_reference(traced, positions, 3, light, {.paths = 1 << 14});
    for (std::size_t r = 0; r < expected.size(); ++r)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(0.5f * (halves[0][r][c] + halves[1][r][c]), expected[r][c], 0.04f) << r << " " << c;
}

} // namespace
} // namespace prt
