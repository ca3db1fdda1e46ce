// Tests clustered transfer: decoding, constants and sizes.

#include "prt/core/clustered_transfer.h"

#include "prt/core/error.h"
#include "support/predicted.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace prt {
namespace {

struct Shape {
    int order, channels;
    WeightFormat format;
};

/// Returns random bases whose clusters have different numbers of components, and random receivers.
ClusteredTransfer random_transfer(const Shape& shape, std::mt19937& random) {
    ClusteredTransfer t;
    t.bases.layout = layout_of_one(shape.order, shape.channels);
    t.bases.components = {3, 0, 5, 1};
    std::normal_distribution<float> normal;
    t.bases.rows.resize((4 + 9) * t.bases.dimension());
    for (float& v : t.bases.rows)
        v = normal(random);
    t.receivers.format = shape.format;
    if (shape.format == WeightFormat::packed) {
        t.bases.bits = {7, 16, 5, 1, 9, 13, 16, 11, 3}; // some lie across two words
        t.receivers.cluster_bits = 2;
        t.receivers.words = 2;
        const std::vector<ClusterLayout> layouts = cluster_layouts(t.bases);
        for (std::size_t p = 0; p < 101; ++p) {
            const auto k = static_cast<std::uint32_t>(random() % 4);
            std::vector<std::uint32_t> values, words(2);
            const std::size_t first = t.bases.first_rows()[k] - k;
            for (std::size_t j = 0; j < layouts[k].components; ++j)
                values.push_back(static_cast<std::uint32_t>(random() % (1u << t.bases.bits[first + j])));
            pack_words(k, 2, layouts[k], values, words);
            const auto* bytes = reinterpret_cast<const std::byte*>(words.data());
            t.receivers.weights.insert(t.receivers.weights.end(), bytes, bytes + 8);
        }
        return t;
    }
    t.receivers.components = 8;
    for (std::size_t p = 0; p < 101; ++p) {
        const auto cluster = static_cast<std::uint16_t>(random() % 4);
        t.receivers.clusters.push_back(cluster);
        for (int j = 0; j < 8; ++j) {
            const bool used = j < t.bases.components[cluster];
            const float weight = used ? normal(random) : 0.0f;
            const auto* bytes = reinterpret_cast<const std::byte*>(&weight);
            t.receivers.weights.insert(t.receivers.weights.end(), bytes, bytes + sizeof weight);
        }
    }
    return t;
}

class Clustered : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, Clustered,
                         testing::Values(Shape{1, 1, WeightFormat::float32},
                                         Shape{6, 3, WeightFormat::float32},
                                         Shape{4, 3, WeightFormat::float32},
                                         Shape{3, 1, WeightFormat::packed}, Shape{6, 1, WeightFormat::packed},
                                         Shape{3, 3, WeightFormat::packed},
                                         Shape{10, 3, WeightFormat::packed}));

TEST_P(Clustered, RadianceThroughConstantsEqualsDecodedTransferTimesLight) {
    for (const std::vector<PredictorKind>& predictors : test::sets_of_predictors()) {
        std::mt19937 random(5);
        ClusteredTransfer transfer = random_transfer(GetParam(), random);
        test::add_predictors(transfer, predictors, random);
        Light light{GetParam().order, {}};
        std::normal_distribution<float> normal;
        for (int i = 0; i < coefficient_count(light.order); ++i)
            light.coefficients.emplace_back(normal(random), normal(random), normal(random));
        const std::vector<glm::vec3> radiance = exit_radiance(transfer, light);
        const std::vector<glm::vec3> expected = exit_radiance(decode(transfer), light);
        ASSERT_EQ(radiance.size(), expected.size());
        for (std::size_t p = 0; p < radiance.size(); ++p)
            EXPECT_LT(glm::distance(radiance[p], expected[p]), 1e-5f * (50 + glm::length(expected[p]))) << p;
    }
}

TEST_P(Clustered, TransferIsDecodedByTheFormula) {
    for (const std::vector<PredictorKind>& predictors : test::sets_of_predictors()) {
        std::mt19937 random(8);
        ClusteredTransfer transfer = random_transfer(GetParam(), random);
        test::add_predictors(transfer, predictors, random);
        const Transfer decoded = decode(transfer);
        for (std::size_t p = 0; p < decoded.receivers(); ++p) {
            const std::vector<double> expected = test::decoded_by_hand(transfer, p);
            for (std::size_t i = 0; i < expected.size(); ++i)
                EXPECT_NEAR(static_cast<double>(decoded.vector(p)[i]), expected[i], 2e-5) << p;
        }
    }
}

TEST(Predictors, AddScaledCoordinatesLessTheCenterOfTheCluster) {
    ClusteredTransfer t;
    t.bases.layout = layout_of_one(1, 1);
    t.bases.components = {0, 1};
    t.bases.predictors = {{PredictorKind::normal, glm::vec3(0), {2, 4, 8}},
                          {PredictorKind::position, {10, 20, 30}, {1, 0.5f, 0.25f}}};
    t.bases.centers = {0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6};
    // A mean, six rows of predictors and no direction; a mean, six rows and one direction.
    t.bases.rows = {100, 1, 1, 1, 1, 1, 1, 7, 1, 10, 100, 1000, 10000, 100000, 0.5f};
    t.receivers.components = 4;
    t.receivers.clusters = {0, 1};
    const std::vector<float> weights = {0, 0, 0, 0, 3, 0, 0, 0};
    t.receivers.weights.resize(weights.size() * sizeof(float));
    std::memcpy(t.receivers.weights.data(), weights.data(), t.receivers.weights.size());
    t.receivers.predictors = {0, 0, 1, 3, 4, 8, 1, 0, 0, 4, 8, 20};
    EXPECT_EQ(
        decode(t).vectors,
        (std::vector<float>{100 + 8 + 3 + 2 + 2, 7 + (2 - 1) + 10 * (0 - 2) + 100 * (0 - 3) + 1000 * (4 - 4) +
                                                     10000 * (4 - 5) + 100000 * (5 - 6) + 0.5f * 3}));
    EXPECT_EQ(constant_rows(t.bases), 15u);
    EXPECT_EQ(bytes_per_receiver(t), 20u); // predictors need no bytes
}

TEST(ClusteredTransfer, PackedWeightsFollowTheFormat) {
    ClusteredTransfer transfer;
    transfer.bases.layout = layout_of_one(1, 1);
    transfer.bases.components = {0, 4};
    transfer.bases.bits = {7, 6, 6, 5};
    transfer.receivers.format = WeightFormat::packed;
    transfer.receivers.cluster_bits = 8;
    transfer.receivers.words = 1;
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    std::vector<std::uint32_t> words(1);
    pack_words(1, 8, layouts[1], std::vector<std::uint32_t>{127, 0, 21, 31}, words);
    EXPECT_EQ(words[0], 1u | 127u << 8 | 21u << 21 | 31u << 27);
    transfer.receivers.weights.resize(4);
    std::memcpy(transfer.receivers.weights.data(), words.data(), 4);
    std::vector<float> weights(4);
    decode_weights(transfer, layouts, 0, weights);
    EXPECT_EQ(weights[0], 1);
    EXPECT_EQ(weights[1], -1);
    EXPECT_FLOAT_EQ(weights[2], (2 * 21 - 63) / 63.0f);
    EXPECT_EQ(weights[3], 1);
    EXPECT_EQ(bytes_per_receiver(transfer), 4u);
    EXPECT_EQ(bits_per_receiver(transfer), 32u);
}

TEST(ClusteredTransfer, BytesPerReceiverCountBoundArrays) {
    std::mt19937 random(3);
    ClusteredTransfer packed = random_transfer({2, 1, WeightFormat::float32}, random);
    packed.receivers.format = WeightFormat::packed;
    packed.receivers.cluster_bits = 9;
    packed.receivers.words = 2; // 34 bits do not fit one
    packed.bases.components = {2, 3};
    packed.bases.bits = {8, 8, 9, 8, 8};
    packed.receivers.clusters.clear();
    packed.receivers.weights.assign(80, std::byte{0});
    EXPECT_EQ(10 * bytes_per_receiver(packed), packed.receivers.weights.size());
    EXPECT_EQ(bits_per_receiver(packed), 34u);

    ClusteredTransfer floats = packed;
    floats.receivers.format = WeightFormat::float32;
    floats.receivers.clusters.assign(10, 0);
    floats.receivers.components = 4; // three in use
    floats.receivers.weights.assign(160, std::byte{0});
    EXPECT_EQ(10 * bytes_per_receiver(floats),
              floats.receivers.weights.size() + 40); // the cluster's byte is padded to four
    EXPECT_EQ(bits_per_receiver(floats), 8u + 3 * 32);
}

TEST(ClusteredTransfer, TruncatesHigherOrdersOfLightAndRejectsLowerOnes) {
    std::mt19937 random(1);
    const ClusteredTransfer transfer = random_transfer({3, 1, WeightFormat::float32}, random);
    const Light light = cone_light(6, {0, 1, 0}, 1, glm::vec3(1));
    const auto cut = exit_radiance(transfer, light), same = exit_radiance(transfer, truncated(light, 3));
    EXPECT_EQ(cut, same);
    EXPECT_THROW(exit_radiance(transfer, truncated(light, 2)), Error);
}

/// Against the definition, weight by weight.
TEST(Evaluate, RunsOfAClusterEqualSingleReceivers) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const int components : {0, 1, 5, 8, 12}) {
        const std::vector<PredictorKind>& predictors =
            test::sets_of_predictors()[static_cast<std::size_t>(components) % 4];
        ClusteredTransfer t;
        t.bases.layout = layout_of_one(1, 1);
        t.bases.components = {components, components > 2 ? components - 2 : 0};
        for (std::size_t i = 0; i < constant_rows(t.bases); ++i)
            t.bases.rows.push_back(normal(random));
        t.receivers.components = (components + 3) / 4 * 4;
        for (int p = 0; p < 100; ++p) // 40, then 33, then single ones
            t.receivers.clusters.push_back(static_cast<std::uint16_t>(p < 40 ? 1 : p < 73 ? 0 : p % 2));
        std::vector<float> stored(100 * static_cast<std::size_t>(t.receivers.components));
        for (float& weight : stored)
            weight = unit(random);
        const auto bytes = std::as_bytes(std::span(stored));
        t.receivers.weights.assign(bytes.begin(), bytes.end());
        test::add_predictors(t, predictors, random);
        std::vector<glm::vec4> constants(constant_rows(t.bases));
        for (glm::vec4& c : constants)
            c = {normal(random), normal(random), normal(random), 0};
        std::vector<glm::vec3> radiance(100, glm::vec3(-9));
        evaluate(t, constants, radiance, 1);
        const auto layouts = cluster_layouts(t.bases);
        for (std::size_t p = 0; p < 100; ++p) {
            std::vector<float> weights(12);
            decode_weights(t, layouts, p, weights);
            const ClusterLayout& layout = layouts[t.receivers.clusters[p]];
            glm::vec3 expected(constants[layout.first_row]);
            const std::size_t known = t.bases.predictor_rows();
            for (std::size_t g = 0; g < known; ++g)
                expected +=
                    t.receivers.predictors[p * known + g] * glm::vec3(constants[layout.first_row + 1 + g]);
            for (std::size_t j = 0; j < layout.components; ++j)
                expected += weights[j] * glm::vec3(constants[layout.first_row + 1 + known + j]);
            EXPECT_LT(glm::distance(radiance[p], expected), 1e-5f) << components << " " << p;
        }
    }
}

TEST(ClusteredTransfer, PackedWeightsRoundTripAcrossWords) {
    // Directions are unit vectors and the mean is zero, so that the decoded values are the weights.
    ClusteredTransfer t;
    t.bases.layout = layout_of_one(3, 1);
    t.bases.components = {8};
    t.bases.bits = {7, 16, 5, 9, 13, 16, 11, 3}; // the fourth and the sixth lie across two words
    t.bases.rows.assign(9 * 9, 0.0f);
    for (std::size_t j = 0; j < 8; ++j)
        t.bases.rows[(j + 1) * 9 + j] = 1;
    t.receivers.format = WeightFormat::packed;
    t.receivers.cluster_bits = 2;
    t.receivers.words = 3;
    std::mt19937 random(6);
    std::vector<std::uint32_t> values;
    for (std::size_t p = 0; p < 50; ++p) {
        std::vector<std::uint32_t> words(3);
        for (std::size_t j = 0; j < 8; ++j)
            values.push_back(static_cast<std::uint32_t>(random() % (1u << t.bases.bits[j])));
        pack_words(0, 2, cluster_layouts(t.bases)[0], std::span(values).last(8), words);
        const auto* bytes = reinterpret_cast<const std::byte*>(words.data());
        t.receivers.weights.insert(t.receivers.weights.end(), bytes, bytes + 12);
    }
    const Transfer decoded = decode(t);
    for (std::size_t p = 0; p < 50; ++p)
        for (std::size_t j = 0; j < 8; ++j)
            EXPECT_NEAR(static_cast<double>(decoded.vector(p)[j]),
                        2.0 * values[8 * p + j] / ((1u << t.bases.bits[j]) - 1) - 1, 1e-6)
                << p << " " << j;
}

} // namespace
} // namespace prt
