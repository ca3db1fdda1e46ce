// Vertices that are split for other reasons than light.

#include "prt/bake/bake.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

namespace prt {
namespace {

using test::SceneBuilder;

Transfer baked(const Scene& scene, int rays, std::uint64_t seed = 0) {
    BakeOptions options;
    options.order = 2;
    options.rays = rays;
    options.seed = seed;
    options.bounces = 1;
    options.tracer.backend = Backend::cpu;
    return bake(scene, options).baked.transfer;
}

/// A floor of separate quads under a lid, so that every vertex has noise.
Scene floor_under_lid() {
    return test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 6).build(),
                                     SceneBuilder().disc({0, 1, 0}, {0, -1, 0}, 1, 12).build()}),
                         glm::vec3(0.5f));
}

TEST(SharedPositions, HaveOneValue) {
    const Scene scene = floor_under_lid();
    const Transfer transfer = baked(scene, 64);
    std::map<std::tuple<float, float, float>, std::size_t> first;
    std::size_t shared = 0;
    for (std::size_t v = 0; v < scene.vertex_arrays[0].size(); ++v) {
        const glm::vec3& at = scene.vertex_arrays[0].positions[v];
        const auto [found, is_new] = first.try_emplace({at.x, at.y, at.z}, v);
        shared += !is_new;
        for (std::size_t i = 0; i < transfer.dimension(); ++i)
            ASSERT_EQ(transfer.vector(v)[i], transfer.vector(found->second)[i]) << v << " " << i;
    }
    EXPECT_GT(shared, 100u);
}

/// Six triangles meet at a vertex inside the floor: the mean of six sets of rays has less noise than one.
TEST(SharedPositions, CombineAllTheirRays) {
    const Scene scene = floor_under_lid();
    // Corners of different triangles get different positions; 0.1 mm does not change their light.
    Scene separate = scene;
    for (std::size_t v = 0; v < separate.vertex_arrays[0].size(); ++v) {
        glm::vec3& at = separate.vertex_arrays[0].positions[v];
        at.x += 1e-5f * static_cast<float>(v % 7);
        at.z += 1e-5f * static_cast<float>(v % 11);
    }
    const auto noise = [](const Scene& of) {
        const Transfer truth = baked(of, 1 << 14, 1);
        double sum = 0;
        for (std::uint64_t seed = 2; seed < 6; ++seed) {
            const Transfer some = baked(of, 64, seed);
            for (std::size_t v = 0; v < of.vertex_arrays[0].size(); ++v)
                if (const glm::vec3& at = of.vertex_arrays[0].positions[v]; glm::length(at) < 1.5f)
                    for (std::size_t i = 0; i < some.dimension(); ++i)
                        sum += std::pow(static_cast<double>(some.vector(v)[i] - truth.vector(v)[i]), 2);
        }
        return std::sqrt(sum);
    };
    EXPECT_NEAR(noise(scene) / noise(separate), 1 / std::sqrt(6), 0.1);
}

/// A sheet is on the edges in the middle of a floor.
TEST(SharedPositions, DoNotCrossAWall) {
    const Scene scene =
        test::painted(test::join({SceneBuilder().floor({0, 0, 0}, 2, 4).build(),
                                  SceneBuilder().quad({0, 0, 3}, {0, 0, -3}, {0, 5, -3}, {0, 5, 3}).build()}),
                      glm::vec3(0.5f), true);
    const Transfer transfer = baked(scene, 256);
    std::size_t at_the_wall = 0;
    for (const glm::uvec3& t : scene.primitives[0].triangles)
        for (int i = 0; i < 3; ++i) {
            const std::vector<glm::vec3>& positions = scene.vertex_arrays[0].positions;
            if (positions[t[i]].x != 0)
                continue;
            const float side = positions[t.x].x + positions[t.y].x + positions[t.z].x;
            EXPECT_LT(transfer.vector(t[i])[3] * side, -0.05f) << t[i]; // from that side: Y_11 is -0.49 x
            ++at_the_wall;
        }
    EXPECT_GT(at_the_wall, 20u);
}

} // namespace
} // namespace prt
