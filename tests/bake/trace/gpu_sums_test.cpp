// Compares sums of vectors on the GPU with sums over Embree's hits.

#include "bake/trace/embree_tracer.h"
#include "bake/trace/vector_sums.h"
#include "bake/trace_gpu/vulkan_tracer.h"
#include "prt/core/sh_basis.h"
#include "support/gpu_scenes.h"
#include "support/traced.h"
#include "support/vulkan_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace prt {
namespace {

constexpr std::size_t kSums = 7;

/// Random rows of all receivers of a scene.
class Summed {
public:
    explicit Summed(Scene scene, std::size_t piece_bytes = 64 << 20)
        : scene_(std::move(scene)), traced_(scene_, {test::dotted_texture()}),
          receivers_(vertex_receivers(scene_)), indices_(receivers_on_surfaces(receivers_)),
          gpu(traced_, test::vulkan_choice(), piece_bytes) {
        std::mt19937 random(5);
        std::uniform_int_distribution<std::uint32_t> sum(0, kSums); // the last index: no sum
        std::uniform_real_distribution<float> unit(0, 1);
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            SumRow row{{}, {}, i % 3 == 0 ? -1.0f : 1.0f};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t s = sum(random);
                row.sums[k] = s == kSums ? kNoSum : s;
                row.weights[k] = unit(random);
                if (s < kSums)
                    weights_[s] += row.weights[k];
            }
            rows_.push_back(row);
        }
    }
    ~Summed() { test::expect_valid(gpu.vulkan()); }

    struct Result {
        std::vector<float> sums, signed_sums, first;
    };
    Result on_gpu(const TraceOptions& options, const HitSink& sink = {}) {
        const std::unique_ptr<VectorSums> sums = gpu.vector_sums(options.order, weights_);
        Result result = empty(options);
        const std::size_t half = indices_.size() / 2; // two batches
        const std::span all(indices_);
        const std::span<float> first(result.first);
        const std::size_t of_half = half * first_coefficients(options.order);
        sums->trace(receivers_, all.first(half), options, std::span(rows_).first(half), first.first(of_half),
                    sink, {});
        sums->trace(receivers_, all.subspan(half), options, std::span(rows_).subspan(half),
                    first.subspan(of_half), sink, {});
        sums->read(result.sums, result.signed_sums);
        return result;
    }
    Result expected(const TraceOptions& options) {
        EmbreeTracer cpu(traced_);
        const Transfer vectors = test::traced(cpu, receivers_, options);
        const auto stride = static_cast<std::size_t>(coefficient_count(options.order));
        Result result = empty(options);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const float* const vector = vectors.vector(indices_[i]).data();
            const std::size_t some = first_coefficients(options.order);
            std::copy_n(vector, some, &result.first[i * some]);
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t c = 0; rows_[i].sums[k] != kNoSum && c < stride; ++c) {
                    const float part = rows_[i].weights[k] * vector[c];
                    result.sums[rows_[i].sums[k] * stride + c] += part;
                    result.signed_sums[rows_[i].sums[k] * stride + c] += rows_[i].sign * part;
                }
        }
        return result;
    }

private:
    Result empty(const TraceOptions& options) const {
        const std::size_t size = kSums * static_cast<std::size_t>(coefficient_count(options.order));
        return {std::vector<float>(size), std::vector<float>(size),
                std::vector<float>(indices_.size() * first_coefficients(options.order))};
    }

    Scene scene_;
    TraceScene traced_;
    Receivers receivers_;
    std::vector<std::uint32_t> indices_;
    std::vector<SumRow> rows_;
    std::vector<float> weights_ = std::vector<float>(kSums);

public:
    VulkanTracer gpu;
};

double relative(std::span<const float> expected, std::span<const float> found) {
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        error += std::pow(static_cast<double>(expected[i]) - static_cast<double>(found[i]), 2);
        norm += std::pow(static_cast<double>(expected[i]), 2);
    }
    return std::sqrt(error / norm);
}

/// Error by one or two grazing rays with so few receivers.
constexpr double kGrazingRays = 3e-4;

void expect_same(const Summed::Result& expected, const Summed::Result& found) {
    EXPECT_LT(relative(expected.sums, found.sums), kGrazingRays);
    EXPECT_LT(relative(expected.signed_sums, found.signed_sums), 4 * kGrazingRays); // less is left of them
    EXPECT_LT(relative(expected.first, found.first), kGrazingRays);
}

TEST(GpuSums, MatchTheVectors) {
    Summed summed(test::balls_over_floor());
    for (const auto& [order, rays] : {std::pair{1, 64}, {6, 100}, {10, 64}, {3, 3000}}) {
        SCOPED_TRACE(order);
        const TraceOptions options{.order = order, .rays = rays, .seed = 4};
        expect_same(summed.expected(options), summed.on_gpu(options));
    }
}

TEST(GpuSums, DoNotDependOnTheOrder) {
    Summed large(test::balls_over_floor()), small(test::balls_over_floor(), 40 << 10);
    const TraceOptions options{.order = 5, .rays = 200, .seed = 2};
    const Summed::Result found = large.on_gpu(options);
    EXPECT_EQ(found.sums, large.on_gpu(options).sums);
    EXPECT_EQ(found.sums, small.on_gpu(options).sums);
    EXPECT_EQ(found.signed_sums, small.on_gpu(options).signed_sums);
}

TEST(GpuSums, AddNoHitTwiceAfterBufferOverflow) {
    for (const std::size_t bytes : {2u << 10, 64u << 10, 64u << 20}) {
        SCOPED_TRACE(bytes);
        Summed summed(test::under_a_ceiling(AlphaMode::blend), bytes);
        const TraceOptions options{.order = 3, .rays = 200, .seed = 1};
        expect_same(summed.expected(options),
                    summed.on_gpu(options, [](std::size_t, std::span<const Hit>) {}));
        expect_same(summed.expected(options), summed.on_gpu(options));
    }
}

} // namespace
} // namespace prt
