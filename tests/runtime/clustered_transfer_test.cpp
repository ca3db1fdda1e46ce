#include "prt/clustered_transfer.h"

#include "prt/error.h"

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

/// Random bases whose clusters have different numbers of components, and random receivers.
ClusteredTransfer random_transfer(const Shape& shape, std::mt19937& random) {
    ClusteredTransfer t;
    t.bases.order = shape.order;
    t.bases.channels = shape.channels;
    t.bases.components = {3, 0, 5, 1};
    std::normal_distribution<float> normal;
    t.bases.rows.resize((4 + 9) * t.bases.dimension());
    for (float& v : t.bases.rows)
        v = normal(random);
    for (int i = 0; i < 9; ++i)
        t.bases.scales.push_back(shape.format == WeightFormat::float32 ? 1.0f : 0.1f + static_cast<float>(i));
    t.receivers.format = shape.format;
    t.receivers.components = 8;
    for (std::size_t p = 0; p < 101; ++p) {
        const auto cluster = static_cast<std::uint16_t>(random() % 4);
        t.receivers.clusters.push_back(cluster);
        for (int j = 0; j < 8; ++j) {
            const bool used = j < t.bases.components[cluster];
            const auto push = [&](auto value) {
                const auto* bytes = reinterpret_cast<const std::byte*>(&value);
                t.receivers.weights.insert(t.receivers.weights.end(), bytes, bytes + sizeof value);
            };
            switch (shape.format) {
            case WeightFormat::float32:
                push(used ? normal(random) : 0.0f);
                break;
            case WeightFormat::snorm16:
                push(static_cast<std::int16_t>(used ? random() : 0));
                break;
            case WeightFormat::snorm8:
                push(static_cast<std::int8_t>(used ? random() : 0));
                break;
            }
        }
    }
    return t;
}

class Clustered : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, Clustered,
                         testing::Values(Shape{1, 1, WeightFormat::float32},
                                         Shape{3, 1, WeightFormat::snorm8},
                                         Shape{6, 3, WeightFormat::snorm16},
                                         Shape{10, 3, WeightFormat::snorm8},
                                         Shape{4, 3, WeightFormat::float32}));

TEST_P(Clustered, RadianceThroughConstantsEqualsDecodedTransferTimesLight) {
    std::mt19937 random(5);
    const ClusteredTransfer transfer = random_transfer(GetParam(), random);
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

TEST(ClusteredTransfer, IntegersDecodeAsInOpenGl) {
    ClusteredReceivers receivers;
    receivers.format = WeightFormat::snorm8;
    receivers.components = 4;
    receivers.clusters = {0};
    receivers.weights = {std::byte{127}, std::byte{0x81}, std::byte{0x80}, std::byte{0}};
    EXPECT_EQ(receivers.weight(0, 0), 1);
    EXPECT_EQ(receivers.weight(0, 1), -1); // -127
    EXPECT_EQ(receivers.weight(0, 2), -1); // -128
    EXPECT_EQ(receivers.weight(0, 3), 0);
}

TEST(ClusteredTransfer, ALightOfHigherOrderIsCutAndALowerOneRefused) {
    std::mt19937 random(1);
    const ClusteredTransfer transfer = random_transfer({3, 1, WeightFormat::float32}, random);
    const Light light = cone_light(6, {0, 1, 0}, 1, glm::vec3(1));
    const auto cut = exit_radiance(transfer, light), same = exit_radiance(transfer, truncated(light, 3));
    EXPECT_EQ(cut, same);
    EXPECT_THROW(exit_radiance(transfer, truncated(light, 2)), Error);
}

} // namespace
} // namespace prt
