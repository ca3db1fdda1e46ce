// The vertex shader against the C++ evaluation, read back from the GPU.

#include "prt/compress/compress.h"
#include "prt/gl/gl_renderer.h"
#include "prt/shader/shader_source.h"
#include "runtime/render/gl/gl_transfer.h"

#include "support/gl_radiance.h"
#include "support/predicted.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

struct Kind {
    int order, channels, clusters, components;
    WeightFormat format;
    int bits = 0;
};
void PrintTo(const Kind& k, std::ostream* out) {
    *out << "order " << k.order << ", " << k.channels << " channels, " << k.clusters << " x " << k.components;
}

class VertexShader : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(
    Kinds, VertexShader,
    testing::Values(Kind{6, 1, 16, 8, WeightFormat::float32}, Kind{4, 3, 8, 5, WeightFormat::float32},
                    Kind{3, 1, 4, 0, WeightFormat::float32}, Kind{10, 1, 2, 48, WeightFormat::float32},
                    Kind{10, 1, 2, 44, WeightFormat::float32}, Kind{5, 1, 300, 2, WeightFormat::float32},
                    Kind{6, 1, 16, 16, WeightFormat::packed, 24},
                    Kind{4, 3, 300, 16, WeightFormat::packed, 200}, Kind{3, 1, 1, 4, WeightFormat::packed, 9},
                    Kind{3, 1, 7, 4, WeightFormat::packed, 0}));

/// Random transfer, compressed.
ClusteredTransfer compressed_of(const Kind& kind, std::mt19937& random) {
    std::normal_distribution<float> normal;
    Transfer transfer{layout_of_one(kind.order, kind.channels), {}};
    transfer.vectors.resize(2000 * transfer.dimension());
    for (std::size_t i = 0; i < transfer.vectors.size(); ++i)
        transfer.vectors[i] = normal(random) + (i % transfer.dimension() == 0 ? 3.0f : 0.0f);
    CompressOptions options;
    options.clusters = kind.clusters;
    options.coding.components = kind.components;
    options.coding.format = kind.format;
    options.coding.bits = kind.bits;
    return compress(transfer, {std::vector<float>(transfer.receivers(), 1.0f)}, options).transfer;
}

Light random_light(int order, std::mt19937& random) {
    std::normal_distribution<float> normal;
    Light light = constant_light(order, glm::vec3(1));
    for (glm::vec3& c : light.coefficients)
        c += 0.3f * glm::vec3(normal(random), normal(random), normal(random));
    return light;
}

float largest_relative_difference(const ClusteredTransfer& compressed, const Light& light,
                                  const GlContext& context) {
    const auto expected = exit_radiance(compressed, light);
    const auto measured = test::exit_radiance_gl(compressed, {light}, context);
    EXPECT_EQ(measured.size(), expected.size());
    float largest = 0;
    for (std::size_t p = 0; p < expected.size(); ++p)
        largest = std::max(largest, glm::distance(expected[p], measured[p]) /
                                        std::max(1.0f, glm::length(expected[p])));
    return largest;
}

TEST_P(VertexShader, AgreesWithCppPerVertex) {
    const Kind kind = GetParam();
    std::string why;
    const auto context = GlContext::create(GlDevice::any, &why);
    ASSERT_TRUE(context) << why;
    std::mt19937 random(9);
    const ClusteredTransfer plain = compressed_of(kind, random);
    const Light light = random_light(kind.order, random);
    for (const std::vector<PredictorKind>& predictors : test::sets_of_predictors()) {
        ClusteredTransfer compressed = plain;
        test::add_predictors(compressed, predictors, random);
        if (compressed.bases.max_components() > max_vertex_components(compressed.bases))
            continue;
        const float largest = largest_relative_difference(compressed, light, *context);
        RecordProperty("largest_relative_difference_1e9", std::to_string(1e9f * largest));
        EXPECT_LT(largest, 1e-5f) << predictors.size();
    }
}

TEST(GlTransfer, TooManyComponentsAreRejected) {
    const auto context = GlContext::create(GlDevice::any);
    ASSERT_TRUE(context);
    ClusteredTransfer transfer;
    transfer.bases.layout = layout_of_one(10, 1);
    transfer.bases.components = {49};
    transfer.bases.rows.resize(50 * 100);
    EXPECT_THROW(GlTransfer{transfer}, Error);
    transfer.bases.components = {16};
    transfer.receivers.format = WeightFormat::packed;
    transfer.receivers.words = 9;
    EXPECT_THROW(GlTransfer{transfer}, Error);
}

} // namespace
} // namespace prt
