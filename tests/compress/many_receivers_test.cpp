// Tests enough receivers that points are stored in 16 bits, and seams are solved in stretches.

#include "compress/tuning/tuning.h"
#include "prt/compress/compress.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr std::uint32_t kSide = 264;
static_assert(kSide * kSide > tuning::kManyReceivers && kSide * kSide > tuning::kSolvedTogether);

/// Waves over a square, float16 as in a file.
struct Waves {
    StoredTransfer stored{layout_of_one(2, 1), {}, {}};
    Transfer floats = zero_transfer(2, 1, kSide* kSide);
    std::vector<Edge> edges;
    std::vector<float> areas = std::vector<float>(kSide * kSide, 1.0f);

    Waves() {
        for (std::uint32_t p = 0; p < kSide * kSide; ++p) {
            const std::uint32_t x = p % kSide, y = p / kSide;
            const float u = static_cast<float>(x) / kSide, v = static_cast<float>(y) / kSide;
            const float values[] = {1 + std::sin(7 * u) * std::cos(5 * v), std::sin(23 * u * v),
                                    std::cos(40 * v) * u, std::sin(31 * (u + v))};
            for (std::size_t i = 0; i < 4; ++i) {
                stored.halves.push_back(glm::packHalf1x16(values[i]));
                floats.vector(p)[i] = glm::unpackHalf1x16(stored.halves.back());
            }
            if (x + 1 < kSide)
                edges.push_back({p, p + 1});
            if (y + 1 < kSide)
                edges.push_back({p, p + kSide});
        }
    }
    CompressResult compressed(const TransferView& transfer, int threads) const {
        CompressOptions options{.clusters = 4, .coding = preset_u32(), .metric = plain_metric(floats.layout)};
        options.threads = threads;
        return compress(transfer, {areas, edges}, options);
    }
};

TEST(ManyReceivers, DoNotDependOnThreadsOrStorage) {
    const Waves waves;
    const CompressResult one = waves.compressed(waves.floats, 1), other = waves.compressed(waves.stored, 3);
    EXPECT_EQ(one.transfer.bases.rows, other.transfer.bases.rows);
    EXPECT_EQ(one.transfer.receivers.weights, other.transfer.receivers.weights);
    EXPECT_EQ(one.statistics.lit_rms, other.statistics.lit_rms);
    // Four components of six bits leave a small error in four numbers; rounding of points, 1/65534 of the
    // range of 1024 of them, is far below it.
    EXPECT_LT(one.statistics.lit_rms, 0.02);
    EXPECT_GT(one.statistics.lit_rms, 1e-4);
}

} // namespace
} // namespace prt
