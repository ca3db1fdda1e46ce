// Textures of lightmaps and volumes against the light that they contain.

#include "prt/core/texture_relighter.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/domains/texel_formats.h"
#include "support/random_lightmap.h"
#include "support/random_volume.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace prt {
namespace {

class Formats : public testing::TestWithParam<TexelFormat> {};
INSTANTIATE_TEST_SUITE_P(All, Formats,
                         testing::Values(TexelFormat::rgb9e5, TexelFormat::r11g11b10, TexelFormat::rgba16,
                                         TexelFormat::rgba32));

/// Returns the maximum error of one color; relative to the largest color if it determines the exponent.
float largest_error(TexelFormat format, const glm::vec3& truth, int color) {
    const float largest = std::max({truth.r, truth.g, truth.b, 0x1p-15f});
    const float own = std::max(truth[color], 0x1p-14f);
    if (format == TexelFormat::rgb9e5)
        return largest * 0x1p-9f;
    if (format == TexelFormat::rgba32)
        return own * 0x1p-22f; // sums of means in another sequence
    if (format == TexelFormat::rgba16)
        return own * 0x1p-11f;
    return own * (color == 2 ? 0x1p-6f : 0x1p-7f);
}

/// One cluster for each color, without weights: a texel contains the constant, to the bit.
struct Palette {
    CompressedLightmap lightmap;
    std::vector<glm::vec4> constants;

    explicit Palette(const std::vector<glm::vec3>& colors) {
        lightmap.layout.maps = {{static_cast<int>(colors.size()), 1}};
        ClusteredTransfer& t = lightmap.compressed.transfer;
        t.bases.layout = layout_of_one(1, 1);
        t.bases.components.assign(colors.size(), 0);
        t.bases.rows.resize(colors.size());
        t.receivers.format = WeightFormat::packed;
        t.receivers.cluster_bits = 16;
        t.receivers.words = 1;
        t.receivers.weights.resize(4 * colors.size());
        for (std::size_t k = 0; k < colors.size(); ++k) {
            const auto word = static_cast<std::uint32_t>(k);
            std::memcpy(&t.receivers.weights[4 * k], &word, sizeof word);
            constants.emplace_back(colors[k], 0);
        }
    }
    std::vector<glm::vec3> stored(TexelFormat format) const {
        const TextureRelighter relighter(lightmap, format);
        std::vector<std::byte> texels(relighter.bytes(0));
        relighter.update(0, constants, texels, 1);
        std::vector<glm::vec3> colors;
        for (std::size_t i = 0; i < constants.size(); ++i)
            colors.push_back(read_texel(format, &texels[i * bytes_per_texel(format)]));
        return colors;
    }
};

TEST_P(Formats, RoundRadianceCorrectly) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-12, 15);
    std::vector<glm::vec3> colors;
    for (int i = 0; i < 3000; ++i)
        colors.emplace_back(std::exp2(exponent(random)), std::exp2(exponent(random)),
                            std::exp2(exponent(random)));
    colors.insert(colors.end(), {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.25f, 2}});
    const std::vector<glm::vec3> stored = Palette(colors).stored(GetParam());
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(stored[i][c], colors[i][c], largest_error(GetParam(), colors[i], c)) << i << " " << c;
    EXPECT_EQ(stored[3001], glm::vec3(1)); // powers of two exactly
    EXPECT_EQ(stored[3002], glm::vec3(0.5f, 0.25f, 2));
}

TEST_P(Formats, ClampNegativeAndInfiniteValues) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec3> stored =
        Palette({{-1, 2, -infinity}, {infinity, 1e30f, 70000}, {std::nanf(""), 0, 0}}).stored(GetParam());
    EXPECT_EQ(stored[0].r, 0);
    EXPECT_EQ(stored[0].b, 0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(stored[1][c]));
        EXPECT_GT(stored[1][c], 64000);
    }
    EXPECT_EQ(stored[2], glm::vec3(0));
}

TEST_P(Formats, MipLevelsAreMeans) {
    std::mt19937 random(3);
    for (const LightmapSize& size : {LightmapSize{130, 66}, {1, 1}, {1, 9}, {5, 3}, {200, 1}}) {
        const CompressedLightmap lightmap = test::random_lightmap({size}, 1, false, random);
        const TextureRelighter relighter(lightmap, GetParam());
        std::vector<glm::vec4> computed(relighter.rows());
        for (glm::vec4& c : computed)
            c = glm::vec4(1 + static_cast<float>(random() % 100) / 1000, 1, 1, 0); // times any q
        std::vector<std::byte> texels(relighter.bytes(0));
        relighter.update(0, computed, texels, 2);
        const auto at = [&](const TextureLevel& level, int x, int y) {
            return read_texel(GetParam(),
                              &texels[level.first + level.texel(x, y) * bytes_per_texel(GetParam())]);
        };
        const auto levels = relighter.levels(0);
        EXPECT_EQ(levels.back().size, glm::ivec3(1));
        for (std::size_t l = 1; l < levels.size(); ++l)
            for (int y = 0; y < levels[l].size.y; ++y)
                for (int x = 0; x < levels[l].size.x; ++x) {
                    const TextureLevel& from = levels[l - 1];
                    const int right = std::min(2 * x + 1, from.size.x - 1),
                              low = std::min(2 * y + 1, from.size.y - 1);
                    const glm::vec3 mean = 0.25f * (at(from, 2 * x, 2 * y) + at(from, right, 2 * y) +
                                                    at(from, 2 * x, low) + at(from, right, low));
                    for (int c = 0; c < 3; ++c) // the first level is computed from unrounded values
                        EXPECT_NEAR(at(levels[l], x, y)[c], mean[c], 3 * largest_error(GetParam(), mean, c));
                }
    }
}

TEST_P(Formats, MatchEvaluation) {
    std::mt19937 random(8);
    const CompressedLightmap lightmap = test::random_lightmap({{67, 5}, {9, 33}}, 2, false, random);
    const TextureRelighter relighter(lightmap, GetParam());
    std::vector<glm::vec4> computed(relighter.rows());
    relighter.update_constants(constant_light(3, glm::vec3(2, 1, 0.5f)), {}, computed);
    std::vector<glm::vec3> expected(lightmap.layout.texels());
    evaluate(lightmap.compressed.transfer, computed, expected);
    ASSERT_EQ(relighter.textures(), 2u);
    for (std::size_t m = 0; m < 2; ++m) {
        std::vector<std::byte> whole(relighter.bytes(m)), pieces = whole;
        relighter.update(m, computed, whole);
        for (std::size_t y = 0; y < relighter.units(m); y += 2)
            relighter.update_range(m, computed, y, std::min(relighter.units(m), y + 2), pieces);
        relighter.update_smaller_levels(m, pieces);
        EXPECT_EQ(whole, pieces);
        for (std::size_t t = 0; t < lightmap.layout.maps[m].texels(); ++t) {
            const glm::vec3 truth = glm::max(expected[lightmap.layout.first_texels()[m] + t], glm::vec3(0));
            const glm::vec3 stored = read_texel(GetParam(), &whole[t * bytes_per_texel(GetParam())]);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(stored[c], truth[c], largest_error(GetParam(), truth, c));
        }
    }
}

struct Formed {
    std::vector<glm::vec4> constants;
    std::vector<std::byte> texels;
};

Formed updated_by(const TextureRelighter& relighter, const std::optional<glm::vec3>& sun, int threads) {
    Formed computed{std::vector<glm::vec4>(relighter.rows()), std::vector<std::byte>(relighter.bytes(0))};
    relighter.update_constants(test::lighting_of_probes(), sun, computed.constants);
    relighter.update(0, computed.constants, computed.texels, threads);
    return computed;
}

/// Number `n` of a probe from its texel.
float number_at(const TextureRelighter& relighter, TexelFormat format, const std::vector<std::byte>& texels,
                std::size_t texel, std::size_t n) {
    const std::size_t at = 4 * (n / 4 * relighter.atlas().texels_of_plane() + texel) + n % 4;
    if (format == TexelFormat::rgba16) {
        std::uint16_t half = 0;
        std::memcpy(&half, &texels[2 * at], 2);
        return glm::unpackHalf1x16(half);
    }
    float value = 0;
    std::memcpy(&value, &texels[4 * at], 4);
    return value;
}

class VolumeFormats : public testing::TestWithParam<std::tuple<int, TexelFormat>> {};
INSTANTIATE_TEST_SUITE_P(All, VolumeFormats,
                         testing::Combine(testing::Values(2, 3, 4),
                                          testing::Values(TexelFormat::rgba16, TexelFormat::rgba32)));

TEST_P(VolumeFormats, ContainTheLightOfEveryProbeInEveryBrick) {
    const auto [order, format] = GetParam();
    std::mt19937 random(7);
    const CompressedVolume volume = test::random_volume(order, false, random);
    const TextureRelighter relighter(volume, format);
    const VolumeProbes probes = probes_of(volume.grid);
    const std::vector<glm::vec3> incident = incident_light(volume, test::lighting_of_probes());
    const float most =
        format == TexelFormat::rgba16 ? 0x1p-11f : 1e-6f; // half a step; sums have a different order
    for (const int threads : {1, 2}) {
        const Formed computed = updated_by(relighter, std::nullopt, threads);
        for (std::size_t b = 0; b < probes.of_brick.size(); ++b)
            for (std::size_t i = 0; i < kBrickProbes; ++i)
                for (std::size_t n = 0; n < 3 * relighter.atlas().coefficients(); ++n) {
                    const float expected = incident[probes.of_brick[b][i] * relighter.atlas().coefficients() +
                                                    n / 3][static_cast<int>(n % 3)];
                    ASSERT_NEAR(
                        number_at(relighter, format, computed.texels, relighter.atlas().texel(b, i), n),
                        expected, most * std::max(std::abs(expected), 1.0f));
                }
    }
}

TEST(TextureRelighter, RejectsFormatsWithoutSignsForVolumes) {
    std::mt19937 random(7);
    const CompressedVolume volume = test::random_volume(2, false, random);
    for (const TexelFormat format : {TexelFormat::rgb9e5, TexelFormat::r11g11b10})
        EXPECT_THROW(TextureRelighter(volume, format), Error);
}

TEST(TextureRelighter, ComputesSunVisibility) {
    std::mt19937 random(8);
    const CompressedVolume volume = test::random_volume(3, true, random);
    const TextureRelighter relighter(volume, TexelFormat::rgba32);
    const glm::vec3 sun = glm::normalize(glm::vec3(1, 2, -0.5f));
    const Transfer transfer = decode(volume.compressed.transfer);
    const std::size_t size = transfer.dimension();
    std::array<float, 9> basis{};
    evaluate_sh(3, sun, std::span<float>(basis));
    const VolumeProbes probes = probes_of(volume.grid);
    const Formed with = updated_by(relighter, sun, 1), without = updated_by(relighter, std::nullopt, 1);
    int between = 0;
    for (std::size_t i = 0; i < kBrickProbes; ++i) {
        float seen = 0; // direct is the first part, coefficient 0 the first output
        for (std::size_t c = 0; c < 9; ++c)
            seen += transfer.vectors[probes.of_brick[1][i] * size + c] * basis[c] / 0.28209479f;
        const std::size_t texel = relighter.atlas().texel(1, i);
        between += seen > 0 && seen < 1;
        EXPECT_NEAR(number_at(relighter, TexelFormat::rgba32, with.texels, texel, 27),
                    std::clamp(seen, 0.0f, 1.0f), 1e-4f);
        EXPECT_EQ(number_at(relighter, TexelFormat::rgba32, without.texels, texel, 27), 0);
        EXPECT_EQ(number_at(relighter, TexelFormat::rgba32, with.texels, texel, 0),
                  number_at(relighter, TexelFormat::rgba32, without.texels, texel, 0));
    }
    EXPECT_GT(between, 3);
}

} // namespace
} // namespace prt
