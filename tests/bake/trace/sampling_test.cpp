// Tests the samples of rays and their sequences.

#include "bake/trace/chunk_kernels.h"
#include "bake/trace/embree_tracer.h"
#include "bake/trace/sample_sequence.h"
#include "prt/core/sh.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace prt {
namespace {

TEST(SobolChunk, HoldsEveryPointOnce) {
    for (const int rays : {1, 15, 16, 100, 512, 1000, 1024}) {
        const SobolChunk chunk(rays);
        EXPECT_EQ(chunk.x.size() % kPacket, 0u);
        const std::set<std::uint32_t> points(chunk.x.begin(), chunk.x.end());
        EXPECT_EQ(points.size(), static_cast<std::size_t>(rays));
        EXPECT_EQ(*points.rbegin(), static_cast<std::uint32_t>(rays - 1));
    }
}

/// Leaves values on the stack that are invalid for rays.
[[gnu::noinline]] void litter() {
    volatile float stack[1 << 16];
    for (volatile float& value : stack)
        value = std::numeric_limits<float>::infinity();
}

TEST(EmbreeTracer, LanesWithoutRaysDoNotMatter) {
    const Scene scene = test::SceneBuilder().sphere({0, 1, 0}, 1, 8).floor({0, 0, 0}, 3, 4).build();
    const TraceScene traced(scene, {}, {.solid = {}, .threads = 1});
    EmbreeTracer tracer(traced);
    const Receivers receivers = vertex_receivers(scene);
    std::vector<float> vector(4);
    for (const int rays : {1, 3, 17})
        for (std::uint32_t receiver = 0; receiver < 50; ++receiver) {
            litter(); // if Embree checks rays, it aborts at invalid rays of inactive lanes
            tracer.trace(receivers, std::span(&receiver, 1), {.order = 2, .rays = rays, .hit_stride = 2},
                         vector, [](std::size_t, std::span<const Hit>) {});
            EXPECT_TRUE(std::isfinite(vector[0]));
        }
}

TEST(Sobol, IsANetInBaseTwo) {
    // Every elementary interval of area 1/1024 holds one of 1024 points.
    const auto bits = [](std::uint32_t reversed, int count) {
        std::uint32_t leading = 0;
        for (int b = 0; b < count; ++b)
            leading = leading << 1 | (reversed >> b & 1);
        return leading;
    };
    const SobolChunk chunk(1024);
    for (const std::uint32_t index : {0u, 3u}) {
        const SobolOffset offset = sobol_offset(index * kChunk);
        for (int x_bits = 0; x_bits <= 10; ++x_bits) {
            std::set<std::uint32_t> cells;
            for (std::size_t i = 0; i < 1024; ++i)
                cells.insert(bits(chunk.x[i] ^ offset.x, x_bits) << (10 - x_bits) |
                             bits(chunk.y[i] ^ offset.y, 10 - x_bits));
            EXPECT_EQ(cells.size(), 1024u) << index << " " << x_bits;
        }
    }
}

TEST(Directions, AreUnitAboveTheSurfaceAndCosineDistributed) {
    const SobolChunk chunk(1024);
    ChunkDirections d;
    for (const glm::vec3& normal :
         {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5f))}) {
        double cosine = 0;
        generate_directions(chunk, sobol_offset(2 * kChunk), 99, tangent_frame(normal), d);
        for (std::size_t i = 0; i < 1024; ++i) {
            const glm::vec3 w(d.x[i], d.y[i], d.z[i]);
            EXPECT_NEAR(glm::length(w), 1, 1e-6f);
            EXPECT_GT(glm::dot(w, normal), -1e-6f);
            cosine += static_cast<double>(glm::dot(w, normal));
        }
        EXPECT_NEAR(cosine / 1024, 2.0 / 3, 1e-3); // mean cosine of the cosine distribution
    }
}

TEST(Directions, HaveUnitLengthInFloatPrecision) {
    const SobolChunk chunk(1024);
    ChunkDirections d;
    for (std::uint32_t seed = 0; seed < 64; ++seed) {
        generate_directions(chunk, sobol_offset(0), seed, tangent_frame({0, 0, 1}), d);
        for (std::size_t i = 0; i < 1024; ++i) {
            const glm::dvec3 w(d.x[i], d.y[i], d.z[i]);
            // Each component is rounded twice or less, by 2^-24 of itself.
            EXPECT_NEAR(glm::dot(w, w), 1, 4e-7) << w.x << " " << w.y << " " << w.z;
        }
    }
}

TEST(Directions, AreCoherentWithinAPacket) {
    const SobolChunk chunk(1024);
    ChunkDirections d;
    generate_directions(chunk, sobol_offset(0), 1234567, tangent_frame({0, 0, 1}), d);
    // A cell is 1/64 of the disk. The mean distance of two random points on a unit disk is 0.9; in a cell it
    // is less than its diameter, about 0.4.
    double spread = 0;
    for (std::size_t i = 0; i < 1024; ++i) {
        const std::size_t first = i / kPacket * kPacket;
        spread += std::hypot(d.x[i] - d.x[first], d.y[i] - d.y[first]);
    }
    EXPECT_LT(spread / 1024, 0.25);
}

TEST(Directions, DifferBetweenSeeds) {
    const SobolChunk chunk(64);
    ChunkDirections a, b;
    generate_directions(chunk, sobol_offset(0), 1, tangent_frame({0, 0, 1}), a);
    generate_directions(chunk, sobol_offset(0), 2, tangent_frame({0, 0, 1}), b);
    int equal = 0;
    for (std::size_t i = 0; i < 64; ++i)
        equal += a.x[i] == b.x[i];
    EXPECT_LT(equal, 4);
}

TEST(TangentFrame, IsRightHandedAndOrthonormal) {
    for (const glm::vec3& n :
         {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0),
          glm::normalize(glm::vec3(1e-4f, 1e-4f, -1)), glm::normalize(glm::vec3(-3, 2, 1))}) {
        const TangentFrame f = tangent_frame(n);
        EXPECT_NEAR(glm::dot(f.tangent, f.tangent), 1, 1e-6f);
        EXPECT_NEAR(glm::dot(f.tangent, n), 0, 1e-6f);
        EXPECT_LT(glm::distance(glm::cross(f.tangent, f.bitangent), n), 1e-6f);
    }
}

TEST(AddBasis, SumsTheBasisOverAnyNumberOfDirections) {
    const SobolChunk chunk(1024);
    ChunkDirections d;
    generate_directions(chunk, sobol_offset(0), 5, tangent_frame(glm::normalize(glm::vec3(1, 2, 3))), d);
    for (int order = 1; order <= kMaxOrder; ++order)
        for (const int count : {0, 1, 15, 16, 17, 1000, 1024}) {
            std::array<double, 100> sums{}, expected{}, basis{};
            add_basis(order, d, count, nullptr, sums);
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
                evaluate_sh(order, glm::dvec3(d.x[i], d.y[i], d.z[i]), std::span<double>(basis));
                for (std::size_t k = 0; k < static_cast<std::size_t>(coefficient_count(order)); ++k)
                    expected[k] += basis[k];
            }
            for (std::size_t k = 0; k < 100; ++k)
                EXPECT_NEAR(sums[k], expected[k], 1e-3) << order << " " << count << " " << k;
        }
}

} // namespace
} // namespace prt
