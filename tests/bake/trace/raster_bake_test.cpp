// Bakes with depth maps against bakes with rays: bounces, target errors, fits, refinement, texels and probes.
// Here OpenGL is Mesa's software rasteriser; scenes are small.

#include "prt/bake/bake.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/bake/refine.h"
#include "prt/bake/volume_bake.h"
#include "prt/core/error_measures.h"
#include "support/gpu_scenes.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <vector>

namespace prt {
namespace {

using namespace test;

BakeOptions by_rays(int rays, int bounces = 0) {
    BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.bounces = bounces;
    options.repairs.denoise = false;
    options.tracer.backend = Backend::cpu;
    return options;
}

BakeOptions by_maps(int directions, int bounces = 0) {
    BakeOptions options = by_rays(directions, bounces);
    options.tracer.method = BakeMethod::raster;
    options.tracer.backend = Backend::gpu;
    options.tracer.raster_resolution = 256;
    return options;
}

/// Balls over a floor that all reflect most light: a third of the light of the floor is bounced.
Scene bright_balls() {
    return painted(balls_over_floor(), glm::vec3(0.8f));
}

Transfer transfer(const Scene& scene, const BakeOptions& options) {
    return bake(scene, options).baked.transfer;
}

TEST(RasterBake, BouncesTheLightOfDepthMapsByRays) {
    const Scene scene = bright_balls();
    const std::vector<float> areas = receiver_areas(scene);
    const BakeResult maps = bake(scene, by_maps(512, 3)), rays = bake(scene, by_rays(512, 3));
    EXPECT_EQ(maps.baked.record.bounces, 3);
    EXPECT_EQ(maps.baked.record.method, BakeMethod::raster);
    const Transfer direct = transfer(scene, by_rays(512));
    const double error_of_direct = relative_l2(direct, transfer(scene, by_maps(512)), areas),
                 error = relative_l2(rays.baked.transfer, maps.baked.transfer, areas);
    // Both bakes bounce light along the same rays, and each bounce gathers the mean of other receivers: its
    // difference is smaller than that of the direct light.
    EXPECT_LT(error, error_of_direct);
    EXPECT_LT(error, 0.2 * relative_l2(rays.baked.transfer, direct, areas)); // which has no bounces
}

TEST(RasterBake, ReachesATargetErrorWithDirections) {
    const Scene scene = balls_over_floor();
    const std::vector<float> areas = receiver_areas(scene);
    const Transfer reference = transfer(scene, by_maps(1 << 13));
    for (const double target : {0.05, 0.02}) {
        BakeOptions options = by_maps(1);
        options.target_error = target;
        const BakeResult result = bake(scene, options);
        const double error = relative_l2(reference, result.baked.transfer, areas);
        EXPECT_LE(result.statistics.sampling_error, target);
        EXPECT_EQ(result.baked.record.rays & (result.baked.record.rays - 1), 0);
        EXPECT_LT(error, 1.5 * target); // receivers share the directions: the estimate is less certain
        BakeOptions half = options;     // half of the directions miss the target
        half.target_error.reset();
        half.rays = result.baked.record.rays / 2;
        EXPECT_GT(relative_l2(reference, transfer(scene, half), areas), 0.6 * target);
    }
}

TEST(RasterBake, FitsSurfacesToDepthMaps) {
    const Scene scene = balls_over_floor();
    const std::vector<float> areas = receiver_areas(scene);
    BakeOptions maps = by_maps(2048), rays = by_rays(2048);
    maps.fit = rays.fit = FitMode::surface;
    const BakeResult fitted = bake(scene, maps);
    EXPECT_TRUE(fitted.baked.record.fitted);
    EXPECT_EQ(fitted.baked.record.method, BakeMethod::raster);
    const Transfer truth = transfer(scene, rays);
    // A sample has this number of directions; the fit averages over samples.
    const int few = 2048 / fitted.statistics.fit.samples;
    const double error = relative_l2(truth, fitted.baked.transfer, areas);
    EXPECT_LT(error, relative_l2(transfer(scene, by_rays(few)), transfer(scene, by_maps(few)), areas));
    EXPECT_GT(relative_l2(truth, transfer(scene, by_rays(2048)), areas), error); // which is not fitted
}

TEST(RasterBake, RefinesByTheLightOfRays) {
    const Scene scene = balls_over_floor();
    const RefineOptions how{.target = 0.03, .max_vertices = 3000};
    BakeOptions of_maps = by_maps(128), of_rays = by_rays(128);
    of_maps.fit = of_rays.fit = FitMode::automatic;
    const RefineStatistics maps = refine(scene, of_maps, how).statistics,
                           rays = refine(scene, of_rays, how).statistics;
    EXPECT_GT(maps.rounds, 0);
    // GPUs differ from the CPU by grazing rays.
    EXPECT_NEAR(static_cast<double>(maps.after.vertices), static_cast<double>(rays.after.vertices),
                0.05 * static_cast<double>(rays.after.vertices));
}

/// The floor of balls_over_floor(), which fills a map.
struct FloorMap {
    Scene scene = SceneBuilder().floor({0, 0, 0}, 2).build();
    std::vector<Atlas> atlases;

    FloorMap() {
        VertexArray& vertices = scene.vertex_arrays[0];
        vertices.texcoords.assign(1, {});
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords[0].emplace_back((p.x + 2) / 4, (p.z + 2) / 4);
        atlases = plan_atlases(scene, {.size = 8, .uv_set = 0});
    }
};

/// The map has the light of a detailed model: the balls.
TEST(RasterBake, FillsTexelsFromDepthMaps) {
    const FloorMap floor;
    const Scene balls = bright_balls();
    for (const int bounces : {0, 2}) {
        const auto map = [&](const BakeOptions& options) {
            return bake_lightmap(floor.scene, floor.atlases, options, {&balls, 0.01}).lightmap;
        };
        const BakedLightmap maps = map(by_maps(1024, bounces)), rays = map(by_rays(1024, bounces));
        EXPECT_EQ(maps.baked.record.method, BakeMethod::raster);
        ASSERT_EQ(maps.texels, rays.texels);
        const std::vector<float>& areas = rays.areas;
        const double error = relative_l2(rays.baked.transfer, maps.baked.transfer, areas);
        EXPECT_LT(error, 0.04) << bounces; // GpuRaster.ConvergesToTraceWithResolutionAndDirections: 0.03
        const Transfer open = bake_lightmap(floor.scene, floor.atlases, by_rays(64)).lightmap.baked.transfer;
        EXPECT_GT(relative_l2(rays.baked.transfer, open, areas), 4 * error) << bounces;
    }
}

TEST(RasterBake, ReachesATargetErrorOfTexels) {
    const FloorMap floor;
    const Scene balls = balls_over_floor();
    const auto map = [&](const BakeOptions& options) {
        return bake_lightmap(floor.scene, floor.atlases, options, {&balls, 0.01});
    };
    const Transfer reference = map(by_maps(1 << 13)).lightmap.baked.transfer;
    BakeOptions options = by_maps(1);
    options.target_error = 0.04;
    const LightmapBake result = map(options);
    EXPECT_LE(result.statistics.sampling_error, 0.04);
    const double error = relative_l2(reference, result.lightmap.baked.transfer, result.lightmap.areas);
    EXPECT_LT(error, 1.5 * 0.04);
    EXPECT_GT(error, 0.2 * 0.04); // no directions are wasted
}

TEST(RasterBake, LightsProbesBySurfacesFromDepthMaps) {
    const Scene scene = bright_balls();
    const VolumeOptions volume{.spacing = 0.5, .bounds = Bounds{{-1, 0, -1}, {1, 1.5f, 1}}, .rays = 384};
    const Transfer maps = bake_volume(scene, volume, by_maps(512, 2)).volume.baked.transfer,
                   rays = bake_volume(scene, volume, by_rays(512, 2)).volume.baked.transfer;
    const std::vector<float> same(rays.receivers(), 1.0f);
    // Probes have the same rays; light of surfaces is a part of their light, and has the error of depth maps.
    const std::vector<float> areas = receiver_areas(scene);
    const double error_of_surfaces =
        relative_l2(transfer(scene, by_rays(512, 1)), transfer(scene, by_maps(512, 1)), areas);
    EXPECT_LT(relative_l2(rays, maps, same), error_of_surfaces);
    EXPECT_GT(relative_l2(rays, maps, same), 0);
}

} // namespace
} // namespace prt
