// Volumes through the compressor.

#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

/// Returns two bricks whose matrices are a mean and a few directions, as smooth functions of position, plus
/// noise.
BakedVolume smooth_volume(int order, float noise) {
    BakedVolume volume;
    volume.order = order;
    volume.grid = {{0, 0, 0}, 0.5f, {2, 1, 1}, {{{0, 0, 0}, 0}, {{1, 0, 0}, 0}}};
    const VolumeProbes probes = probes_of(volume.grid);
    volume.visibility.assign(probes.size(), ProbeVisibility{200, 200, 200, 200, 200, 200});
    Transfer& t = volume.baked.transfer;
    t.layout = {3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    const std::size_t numbers = volume.coefficients() * t.dimension();
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    std::vector<std::vector<float>> rows(5, std::vector<float>(numbers));
    for (auto& row : rows)
        for (float& v : row)
            v = normal(random);
    for (const glm::ivec3& corner : probes.corners) {
        const glm::vec3 x = 0.2f * glm::vec3(corner);
        const float weights[5] = {2, x.x - 0.8f, x.y - 0.4f, x.z - 0.4f, x.x * x.y};
        for (std::size_t i = 0; i < numbers; ++i) {
            float sum = noise * normal(random);
            for (std::size_t j = 0; j < rows.size(); ++j)
                sum += weights[j] * rows[j][i];
            t.vectors.push_back(sum);
        }
    }
    return volume;
}

/// Measured relative L2 of incident light under a light.
double error_under(const BakedVolume& raw, const CompressedVolume& small, const Lighting& lighting) {
    const std::vector<glm::vec3> a = exit_radiance(raw.baked.transfer, lighting),
                                 b = incident_light(small, lighting);
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        error += static_cast<double>(glm::dot(a[i] - b[i], a[i] - b[i]));
        norm += static_cast<double>(glm::dot(a[i], a[i]));
    }
    return std::sqrt(error / norm);
}

Lighting some_light(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    const auto any = [&] {
        Light light{3, {}};
        for (int i = 0; i < 9; ++i)
            light.coefficients.emplace_back(normal(random), normal(random), normal(random));
        return light;
    };
    return {any(), any()};
}

class CompressedVolumes : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, CompressedVolumes, testing::Values(2, 3, 4));

TEST_P(CompressedVolumes, LoseOnlyQuantizationErrorInFewDimensions) {
    const BakedVolume volume = smooth_volume(GetParam(), 0);
    CompressOptions options;
    options.clusters = 2;
    options.coding = preset_volume();
    options.coding.components = 8;
    const CompressedVolumeResult result = compress_volume(volume, options);
    EXPECT_EQ(result.volume.grid, volume.grid);
    EXPECT_EQ(result.volume.compressed.transfer.bases.layout.outputs, volume.coefficients());
    EXPECT_LE(result.statistics.bytes_per_receiver, 16u);
    EXPECT_LT(result.statistics.lit_rms, 1e-3);
    for (const std::uint32_t seed : {1u, 2u, 3u})
        EXPECT_LT(error_under(volume, result.volume, some_light(seed)), 3e-3);
}

TEST_P(CompressedVolumes, HaveTheExpectedError) {
    const BakedVolume volume = smooth_volume(GetParam(), 0.2f);
    CompressOptions options;
    options.clusters = 1;
    options.coding = preset_volume();
    options.coding.bits = 24;
    options.metric = plain_metric(volume.baked.transfer.layout);
    const CompressedVolumeResult result = compress_volume(volume, options);
    double square = 0;
    constexpr int kLights = 60;
    for (std::uint32_t seed = 0; seed < kLights; ++seed) {
        const double error = error_under(volume, result.volume, some_light(seed));
        square += error * error / kLights;
    }
    EXPECT_GT(result.statistics.lit_rms, 0.02);
    EXPECT_NEAR(std::sqrt(square), result.statistics.lit_rms, 0.12 * result.statistics.lit_rms);
}

TEST(CompressedVolumes, EvaluateTheirDecodedTransfer) {
    const BakedVolume volume = smooth_volume(3, 0.3f);
    CompressOptions options;
    options.clusters = 3;
    options.coding = preset_volume();
    const CompressedVolume small = compress_volume(volume, options).volume;
    Transfer decoded = decode(small.compressed.transfer);
    decoded.layout.outputs = 1;
    const Lighting lighting = some_light(4);
    const std::vector<glm::vec3> expected = exit_radiance(decoded, lighting),
                                 got = incident_light(small, lighting);
    ASSERT_EQ(expected.size(), got.size());
    for (std::size_t i = 0; i < got.size(); ++i)
        EXPECT_LT(glm::distance(expected[i], got[i]), 1e-4f * (1 + glm::length(expected[i])));
}

TEST(CompressedVolumes, HavePackedWeights) {
    CompressOptions options;
    options.coding.format = WeightFormat::float32;
    EXPECT_THROW(compress_volume(smooth_volume(3, 0), options), Error);
}

} // namespace
} // namespace prt
