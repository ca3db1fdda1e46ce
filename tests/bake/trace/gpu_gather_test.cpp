// Compares bounces on the GPU with those on the CPU.

#include "bake/scene/trace_scene.h"
#include "bake/trace/vector_sums.h"
#include "bake/trace_gpu/gpu_gather.h"
#include "prt/core/sh_basis.h"
#include "support/gpu_scenes.h"
#include "support/scene_builder.h"
#include "support/vulkan_choice.h"

#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

/// Rows of random hits in a scene with different materials.
class RandomGather {
public:
    explicit RandomGather(int channels, bool varies)
        : scene_(test::under_a_ceiling(AlphaMode::opaque)),
          traced_(make(scene_, varies)), receivers_{.receivers = vertex_receivers(scene_),
                                                    .back = {},
                                                    .fronts = scene_.receivers()},
          gather(traced_.surfaces(), receivers_, scene_.receivers(), channels) {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(0, 1);
        std::uniform_int_distribution<std::size_t> triangle(0, traced_.surfaces().triangles() - 1);
        for (std::size_t row = 0; row < gather.rows(); ++row) {
            std::vector<Hit> hits(row % 7 == 0 ? 0 : row % 40); // some rows are empty
            for (Hit& hit : hits)
                hit = {static_cast<std::uint32_t>(triangle(random)),
                       0.4f * unit(random),
                       0.4f * unit(random),
                       unit(random),
                       0,
                       false};
            gather.set_row(row, hits, 40);
        }
    }

private:
    static Scene& varied(Scene& scene, bool varies) {
        scene.materials[1].base_color_texture.image = varies ? 0 : -1;
        scene.materials[0].base_color = {0.8f, 0.5f, 0.3f, 1};
        return scene;
    }
    static TraceScene make(Scene& scene, bool varies) {
        return TraceScene(varied(scene, varies), {test::dotted_texture()});
    }

    Scene scene_;
    TraceScene traced_;
    TransportReceivers receivers_;

public:
    GatherOperator gather;
};

Transfer random_exit(const GatherOperator& gather, int order) {
    Transfer exit = zero_transfer(order, gather.channels(), gather.receivers());
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (float& v : exit.vectors)
        v = normal(random);
    return exit;
}

double relative_difference(std::span<const float> expected, std::span<const float> found) {
    double difference = 0, all = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto e = static_cast<double>(expected[i]), f = static_cast<double>(found[i]);
        difference += (e - f) * (e - f);
        all += e * e;
    }
    return std::sqrt(difference / all);
}

struct Case {
    int channels, order;
    bool varies;
    GatherBlocks::Room room;
};
constexpr std::size_t kAll = SIZE_MAX;
/// Blocks of all rows, of a few rows, and of a few rows of which most are uploaded each time.
const Case kCases[] = {{1, 6, false, {}},          {3, 2, false, {}},           {3, 4, true, {}},
                       {3, 3, true, {2048, kAll}}, {1, 10, false, {512, 3000}}, {3, 1, true, {1024, 0}}};

TEST(GpuGather, MatchesCpu) {
    const VulkanDevice device(test::vulkan_choice());
    for (const Case& c : kCases) {
        const RandomGather random(c.channels, c.varies);
        EXPECT_EQ(random.gather.reflectance().empty(), c.varies);
        GpuQueue queue(device);
        GpuGather gpu(device, queue, random.gather, c.room);
        EXPECT_EQ(gpu.blocks().all().size() > 1, c.room.block < 4096);
        EXPECT_EQ(gpu.blocks().all().back().resident, c.room.resident == kAll);
        const Transfer exit = random_exit(random.gather, c.order);
        Transfer reflected = exit;
        random.gather.reflect(c.order, reflected.vectors, 1);
        const std::size_t stride = exit.dimension();
        for (const auto& [first, rows] :
             {std::pair<std::size_t, std::size_t>{0, random.gather.rows()}, {5, 30}}) {
            std::vector<float> expected(rows * stride), found(rows * stride);
            random.gather.apply(c.order, reflected.vectors, first, expected, 1);
            gpu.load(c.order, exit.vectors);
            gpu.apply(first, found);
            EXPECT_LT(relative_difference(expected, found), 1e-6) << c.order << " " << first;
        }
    }
    test::expect_valid(device);
}

TEST(GpuGather, AddsRowsToSums) {
    const VulkanDevice device(test::vulkan_choice());
    constexpr std::size_t kSums = 5;
    const auto row = [](std::size_t r) -> SumRow {
        const auto s = static_cast<std::uint32_t>(r % kSums);
        return {{s, r % 3 == 0 ? kNoSum : (s + 2) % 5, 4}, {0.5f, 2, 0.1f * static_cast<float>(r % 4)}};
    };
    for (const Case& c : kCases) {
        const RandomGather random(c.channels, c.varies);
        GpuQueue queue(device);
        GpuGather gpu(device, queue, random.gather, c.room);
        Transfer exit = random_exit(random.gather, c.order);
        std::vector<float> weights(kSums);
        for (std::size_t r = 0; r < random.gather.rows(); ++r)
            for (std::size_t i = 0; i < 3; ++i)
                if (row(r).sums[i] != kNoSum)
                    weights[row(r).sums[i]] += row(r).weights[i];
        const std::size_t stride = exit.dimension();
        for (const float scale : {1.0f, 1e6f, 0.0f}) { // light of lamps has any unit
            for (float& v : exit.vectors)
                v *= scale;
            Transfer reflected = exit;
            random.gather.reflect(c.order, reflected.vectors, 1);
            std::vector<float> rows(random.gather.rows() * stride), expected(kSums * stride, 3.0f),
                found = expected; // to which they are added
            random.gather.apply(c.order, reflected.vectors, 0, rows, 1);
            for (std::size_t r = 0; r < random.gather.rows(); ++r)
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t k = 0; row(r).sums[i] != kNoSum && k < stride; ++k)
                        expected[row(r).sums[i] * stride + k] += row(r).weights[i] * rows[r * stride + k];
            gpu.load(c.order, exit.vectors);
            EXPECT_TRUE(gpu.apply_to_sums({random.gather.rows(), row, weights}, found));
            // An addition rounds to 2^-30 of the largest value, about 4.5; the sum of 40 canceling terms is
            // 0.01 of the weight: 1.4e-8 of 0.01, and an equal amount for other differences.
            EXPECT_LT(relative_difference(expected, found), 1e-5) << c.order << " " << scale;
        }
    }
    test::expect_valid(device);
}

TEST(GpuGather, AddsBounces) {
    const VulkanDevice device(test::vulkan_choice());
    for (const Case& c : kCases) {
        const RandomGather random(c.channels, c.varies);
        GpuQueue queue(device);
        GpuGather gpu(device, queue, random.gather, c.room);
        const Transfer direct = random_exit(random.gather, c.order);
        Transfer sum = direct, now = direct, next = direct;
        constexpr int kBounces = 3;
        double before = 0;
        for (int b = 0; b < kBounces; ++b) {
            before = 0;
            for (std::size_t v = 0; v < now.vectors.size();
                 v += now.dimension() / static_cast<std::size_t>(c.channels)) {
                double norm = 0;
                for (std::size_t k = 0; k < now.dimension() / static_cast<std::size_t>(c.channels); ++k)
                    norm += static_cast<double>(now.vectors[v + k]) * static_cast<double>(now.vectors[v + k]);
                before = std::max(before, std::sqrt(norm));
            }
            random.gather.reflect(c.order, now.vectors, 1);
            random.gather.apply(c.order, now.vectors, 0, next.vectors, 1);
            for (std::size_t i = 0; i < sum.vectors.size(); ++i)
                sum.vectors[i] += next.vectors[i];
            std::swap(now, next);
        }
        Transfer found = direct;
        const std::optional<BounceEnergy> energy = gpu.bounce(found, kBounces, {});
        ASSERT_TRUE(energy);
        EXPECT_LT(relative_difference(sum.vectors, found.vectors), 1e-6) << c.order;
        EXPECT_NEAR(energy->before_last, before, 1e-5 * before);
        EXPECT_GT(energy->last, 0);
        if (c.room.resident == kAll) { // only transfer is moved, in both directions, and the rows once
            std::size_t rows = 0;
            for (const GatherBlocks::Block& block : gpu.blocks().all())
                rows += 4 * (block.rows + 1) + 4 * block.entries * (1 + (c.varies ? 3u : 1u));
            EXPECT_EQ(gpu.bytes_moved(), rows + 2 * 4 * direct.vectors.size());
        }
    }
    test::expect_valid(device);
}

} // namespace
} // namespace prt
