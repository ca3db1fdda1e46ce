// Culling against brute force.

#include "pictures/triangle_clusters.h"

#include "prt/render/camera.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

namespace viewer {
namespace {

struct Clustered {
    prt::Scene scene = prt::test::SceneBuilder().sphere({0, 0, 0}, 1, 70).floor({0, -1, 0}, 3, 80).build();
    std::vector<TriangleCluster> clusters =
        make_triangle_clusters(scene.primitives[0], scene.vertex_arrays[0]);
};

/// Every corner is on the wrong side of one plane of the clip volume: the definition, without planes in
/// space.
bool is_outside(const glm::mat4& matrix, const prt::Scene& scene, const glm::uvec3& triangle) {
    bool outside[6] = {true, true, true, true, true, true};
    for (int corner = 0; corner < 3; ++corner) {
        const glm::vec4 p = matrix * glm::vec4(scene.vertex_arrays[0].positions[triangle[corner]], 1);
        const bool out[6] = {p.x<-p.w, p.x> p.w, p.y<-p.w, p.y> p.w, p.z<-p.w, p.z> p.w};
        for (int i = 0; i < 6; ++i)
            outside[i] = outside[i] && out[i];
    }
    return std::any_of(std::begin(outside), std::end(outside), [](bool b) { return b; });
}

using Triple = std::tuple<unsigned, unsigned, unsigned>;

TEST(TriangleClusters, ContainEveryTriangleOnce) {
    const prt::Scene before =
        prt::test::SceneBuilder().sphere({0, 0, 0}, 1, 70).floor({0, -1, 0}, 3, 80).build();
    const Clustered after;
    std::multiset<Triple> a, b;
    for (const glm::uvec3& t : before.primitives[0].triangles)
        a.insert({t.x, t.y, t.z});
    std::uint32_t next = 0;
    for (const TriangleCluster& cluster : after.clusters) {
        EXPECT_EQ(cluster.triangles.first, next);
        next += cluster.triangles.count;
        EXPECT_LE(cluster.triangles.count, kClusterTriangles);
        for (std::uint32_t i = cluster.triangles.first; i < next; ++i) {
            const glm::uvec3& t = after.scene.primitives[0].triangles[i];
            b.insert({t.x, t.y, t.z});
            for (int corner = 0; corner < 3; ++corner) {
                const glm::vec3& p = after.scene.vertex_arrays[0].positions[t[corner]];
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_LE(cluster.box.low[axis], p[axis]);
                    EXPECT_GE(cluster.box.high[axis], p[axis]);
                }
            }
        }
    }
    EXPECT_EQ(a, b);
}

TEST(TriangleClusters, AreEmptyWithoutTriangles) {
    prt::Primitive empty;
    EXPECT_TRUE(make_triangle_clusters(empty, {}).empty());
}

TEST(FrustumPlanes, BoundTheView) {
    // 90 degrees wide and high, from the origin along -z, planes at 1 and 3.
    const prt::Camera camera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.57079633f};
    const glm::mat4 matrix = prt::view_projection(camera, {{-1, -1, -3 / 1.01f}, {1, 1, -1 / 0.99f}}, 1);
    const auto planes = frustum_planes(matrix);
    const auto inside = [&](const glm::vec3& p) { return may_be_visible(planes, {p, p}); };
    EXPECT_TRUE(inside({0, 0, -2}));
    EXPECT_TRUE(inside({1.9f, -1.9f, -2}));
    EXPECT_FALSE(inside({2.1f, 0, -2}));
    EXPECT_FALSE(inside({-2.1f, 0, -2}));
    EXPECT_FALSE(inside({0, 2.1f, -2}));
    EXPECT_FALSE(inside({0, -2.1f, -2}));
    EXPECT_FALSE(inside({0, 0, -0.9f}));
    EXPECT_FALSE(inside({0, 0, -3.1f}));
    EXPECT_FALSE(inside({0, 0, 2})); // behind
}

TEST(Culling, KeepsVisibleTrianglesAndDropsMostOthers) {
    const Clustered model;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto& triangles = model.scene.primitives[0].triangles;
    std::size_t outside = 0, dropped = 0;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 eye = 2.5f * glm::vec3(uniform(random), uniform(random), uniform(random));
        const glm::vec3 target = 1.5f * glm::vec3(uniform(random), uniform(random), uniform(random));
        const prt::Camera camera{eye, target, {0, 1, 0}, 0.3f + 0.5f * std::abs(uniform(random))};
        const glm::mat4 matrix = prt::view_projection(camera, prt::bounds(model.scene), 1.6f);
        const auto ranges = visible_ranges(model.clusters, frustum_planes(matrix));
        std::vector<bool> drawn(triangles.size(), false);
        for (std::size_t r = 0; r < ranges.size(); ++r) {
            if (r > 0) { // joined, and in order
                EXPECT_GT(ranges[r].first, ranges[r - 1].first + ranges[r - 1].count);
            }
            std::fill_n(drawn.begin() + ranges[r].first, ranges[r].count, true);
        }
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const bool out = is_outside(matrix, model.scene, triangles[t]);
            outside += out;
            dropped += !drawn[t];
            if (!drawn[t]) {
                EXPECT_TRUE(out) << "triangle " << t << " of camera " << i;
            }
        }
    }
    EXPECT_GT(dropped, outside * 7 / 10);
}

} // namespace
} // namespace viewer
