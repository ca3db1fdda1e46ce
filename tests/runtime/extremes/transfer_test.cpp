// Tests transfer and its measures with invalid numbers. Measures reject them; forming and evaluating are
// per-frame arithmetic, in which non-finite values propagate (prt/core/cluster_lighting.h), and which must
// stay within their arrays.

#include "prt/core/adjacency.h"
#include "prt/core/cluster_lighting.h"
#include "prt/core/error_measures.h"
#include "support/extremes.h"

#include <cstring>
#include <random>

namespace prt {
namespace {

using test::ExtremeCase;
using test::Numbers;

/// Two receivers.
Transfer transfer_of(int order, float x, float y) {
    Transfer transfer = zero_transfer(order, 3, 2);
    for (float& value : transfer.vectors)
        value = 0.25f;
    transfer.vector(0)[0] = x;
    transfer.vector(1).back() = y;
    return transfer;
}

const std::vector<float> kAreas = {1, 2};
const std::vector<glm::vec3> kGrey(2, glm::vec3(0.5f));

std::vector<glm::vec3> radiance_of(float x, float y) {
    return {glm::vec3(x, 1, 1), glm::vec3(1, 1, y)};
}

const ExtremeCase kMeasures[] = {
    {"relative_l2",
     [](int n, float x, float y) {
         return Numbers{relative_l2(transfer_of(n, 1, 1), transfer_of(n, x, y), kAreas),
                        relative_l2(transfer_of(n, x, y), transfer_of(n, 1, 1), kAreas)};
     }},
    {"relative_l2_of_areas",
     [](int n, float x, float y) {
         return Numbers{
             relative_l2(transfer_of(n, 1, 1), transfer_of(n, 1, 2), std::vector{x * x, y * y + 1})};
     }},
    {"lit_rms",
     [](int, float x, float y) {
         return Numbers{lit_rms(kGrey, radiance_of(x, y), kAreas), lit_rms(radiance_of(x, y), kGrey, kAreas)};
     }},
    {"lit_scale",
     [](int, float x, float y) {
         const LitScale scale = lit_scale(radiance_of(x, y), kAreas);
         return Numbers{scale.mean_square, scale.mean};
     }},
    {"lit_error",
     [](int, float x, float y) {
         const std::vector<std::uint16_t> clusters = {0, 1};
         const std::vector<Edge> edges = {{0, 1}};
         const LitError e = lit_error(kGrey, radiance_of(x, y), kAreas, edges, clusters);
         return Numbers{e.rms,          e.mean,        e.max, e.percentile_999, e.darker_half_rms,
                        e.crossing.rms, e.crossing.max};
     }},
};

class Measure : public testing::TestWithParam<ExtremeCase> {};
INSTANTIATE_TEST_SUITE_P(Functions, Measure, testing::ValuesIn(kMeasures), test::name_of);
TEST_P(Measure, IsFiniteOrRejected) {
    test::expect_finite_or_refused(GetParam());
}

TEST(Measure, IsZeroWithoutReceivers) {
    EXPECT_EQ(lit_rms({}, {}, {}), 0);
    EXPECT_EQ(relative_l2(Transfer{}, Transfer{}, {}), 0);
    EXPECT_EQ(lit_error({}, {}, {}, {}, std::nullopt).rms, 0);
    EXPECT_EQ(mean_visibility({}, {}), 0);
    EXPECT_TRUE(unique_edges({}).empty());
    EXPECT_EQ(Adjacency({}, 0).receivers(), 0u);
}

/// One receiver of one cluster with four components, all of one number.
ClusteredTransfer clustered_of(int order, float value) {
    ClusteredTransfer transfer;
    transfer.bases.layout = layout_of_one(order, 1);
    transfer.bases.components = {4};
    transfer.bases.rows.assign(5 * transfer.bases.dimension(), value);
    transfer.receivers.components = 4;
    transfer.receivers.clusters = {0};
    const std::array<float, 4> weights = {1, -1, 1, value};
    transfer.receivers.weights.resize(sizeof weights);
    std::memcpy(transfer.receivers.weights.data(), weights.data(), sizeof weights);
    return transfer;
}

TEST(TransferArithmetic, StaysWithinItsArraysForAllNumbers) {
    test::for_each_extreme([](int order, float x, float y) {
        const ClusteredTransfer transfer = clustered_of(order, x);
        const ClusterLighting relighter(transfer);
        const std::vector<glm::vec3> light(static_cast<std::size_t>(order * order), glm::vec3(y));
        std::vector<glm::vec4> constants(relighter.rows());
        relighter.update(light, constants);
        blend_constants(constants, constants, y, constants);
        std::vector<glm::vec3> radiance(1);
        evaluate(transfer, constants, radiance, 1);
        exit_radiance(decode(transfer, 1).vector(0), transfer.bases.layout, light);
        mean_visibility(transfer_of(order, x, y), kAreas);
    });
}

TEST(TransferArithmetic, IsFiniteForCommonFiniteNumbers) {
    for (const int order : {1, 10})
        for (const float value : {1e-45f, -0.0f, 1.0f, 1e12f}) {
            const Light light = constant_light(order, glm::vec3(1e12f));
            for (const glm::vec3& r : exit_radiance(clustered_of(order, value), light))
                EXPECT_TRUE(std::isfinite(r.x)) << order << " " << value;
            for (const glm::vec3& r : exit_radiance(transfer_of(order, value, value), light))
                EXPECT_TRUE(std::isfinite(r.x)) << order << " " << value;
        }
}

TEST(TransferArithmetic, IsZeroForEmptyTransfer) {
    ClusteredTransfer nothing;
    nothing.bases.layout = layout_of_one(1, 1);
    const Light light = constant_light(1, glm::vec3(1));
    EXPECT_TRUE(exit_radiance(nothing, light).empty());
    EXPECT_TRUE(decode(nothing).vectors.empty());
    EXPECT_TRUE(exit_radiance(zero_transfer(1, 1, 0), light).empty());
}

TEST(CodedRows, DecodeOrRejectRandomBits) {
    std::mt19937 random(7);
    for (int round = 0; round < 2000; ++round) {
        RowCode code;
        code.drops.resize(random() % 5);
        code.bits.resize(random() % 20);
        for (std::uint8_t& drop : code.drops)
            drop = static_cast<std::uint8_t>(random());
        for (std::byte& byte : code.bits)
            byte = static_cast<std::byte>(random());
        try {
            for (const std::int32_t value : decode_rows(code, random() % 9))
                EXPECT_LE(std::abs(value), 1 << (kMaxRowBits - 1));
        } catch (const Error&) { // refused
        }
    }
}

} // namespace
} // namespace prt
