// Tests our bounding volume hierarchy: its contents and their number formats.

#include "bake/trace_gpu/wide_bvh.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <set>

namespace prt {
namespace {

/// Small triangles at random positions, in the plane z = 0 if `depth` is 0.
struct ScatteredTriangles {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> corners;

    ScatteredTriangles(std::size_t count, float depth) {
        std::mt19937 random(5);
        std::normal_distribution<float> normal(0, 100);
        for (unsigned t = 0; t < count; ++t) {
            const glm::vec3 a(normal(random), normal(random), 1e-3f * normal(random));
            for (int i = 0; i < 3; ++i)
                positions.push_back((a + glm::vec3(normal(random), normal(random), normal(random)) * 0.01f) *
                                    glm::vec3(1, 1, depth));
            corners.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
        }
    }
};

unsigned byte_of(const glm::uvec2& bytes, unsigned slot) {
    return (slot < 4 ? bytes.x : bytes.y) >> (8 * (slot & 3)) & 255;
}

TEST(WideBvh, HoldsEveryTriangleOnceInsideItsBoxes) {
    for (const auto& [count, depth] : {std::pair(1u, 1.0f),
                                       {2u, 1.0f},
                                       {9u, 1.0f},
                                       {500u, 1.0f},
                                       {3000u, 1.0f},
                                       {1u, 0.0f},
                                       {500u, 0.0f}}) {
        const ScatteredTriangles mesh(count, depth);
        const WideBvh bvh = build_wide_bvh(mesh.positions, mesh.corners, 2);
        std::set<std::uint32_t> seen(bvh.triangles.begin(), bvh.triangles.end());
        EXPECT_EQ(bvh.triangles.size(), count);
        EXPECT_EQ(seen.size(), count);
        std::size_t in_leaves = 0;
        for (const gpu::WideNode& node : bvh.nodes)
            for (unsigned slot = 0; slot < 8; ++slot) {
                const unsigned meta = byte_of(node.meta, slot);
                if (meta == 0 || PRT_IS_INNER(meta))
                    continue;
                for (unsigned i = 0; i < PRT_LEAF_COUNT(meta); ++i) {
                    ++in_leaves;
                    const std::uint32_t t = bvh.triangles[node.first_triangle + PRT_LEAF_FIRST(meta) + i];
                    for (int corner = 0; corner < 3; ++corner)
                        for (unsigned axis = 0; axis < 3; ++axis) {
                            const float step = std::bit_cast<float>(gpu::step_bits(node.exponents, axis)),
                                        origin = node.origin[static_cast<int>(axis)];
                            const auto low = static_cast<float>(byte_of(node.low[axis], slot)),
                                       high = static_cast<float>(byte_of(node.high[axis], slot));
                            const float value =
                                mesh.positions[mesh.corners[t][corner]][static_cast<int>(axis)];
                            EXPECT_TRUE(std::isnormal(step)); // GPUs flush smaller numbers to 0
                            EXPECT_LE(origin + low * step, value);
                            EXPECT_GE(origin + high * step, value);
                        }
                }
            }
        EXPECT_EQ(in_leaves, count);
    }
}

} // namespace
} // namespace prt
