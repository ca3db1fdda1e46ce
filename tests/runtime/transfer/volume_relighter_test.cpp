// Textures of a volume against the light and the visibility that they hold.

#include "prt/core/volume_relighter.h"

#include "prt/core/sh.h"
#include "support/random_volume.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace prt {
namespace {

Lighting lighting_of_probes() {
    Lighting lighting{cone_light(3, {0, 1, 0}, 0.7, {1, 2, 3}), cone_light(3, {1, 0, 0}, 0.2, {3, 2, 1})};
    lighting.lamps = {{0.5f, 1, 2}};
    return lighting;
}

struct Formed {
    std::vector<glm::vec4> constants;
    std::vector<std::byte> texels;
};

Formed updated_by(const VolumeRelighter& relighter, const std::optional<glm::vec3>& sun, int threads) {
    Formed computed{std::vector<glm::vec4>(relighter.rows()), std::vector<std::byte>(relighter.bytes())};
    relighter.update_constants(lighting_of_probes(), sun, computed.constants);
    relighter.update(computed.constants, computed.texels, threads);
    return computed;
}

/// Number `n` of a probe from its texel.
float number_at(const VolumeRelighter& relighter, VolumeFormat format, const std::vector<std::byte>& texels,
                std::size_t texel, std::size_t n) {
    const std::size_t at = 4 * (n / 4 * relighter.atlas().texels_of_plane() + texel) + n % 4;
    if (format == VolumeFormat::rgba16) {
        std::uint16_t half = 0;
        std::memcpy(&half, &texels[2 * at], 2);
        return glm::unpackHalf1x16(half);
    }
    float value = 0;
    std::memcpy(&value, &texels[4 * at], 4);
    return value;
}

class VolumeFormats : public testing::TestWithParam<std::tuple<int, VolumeFormat>> {};
INSTANTIATE_TEST_SUITE_P(All, VolumeFormats,
                         testing::Combine(testing::Values(2, 3, 4),
                                          testing::Values(VolumeFormat::rgba16, VolumeFormat::rgba32)));

TEST_P(VolumeFormats, ContainTheLightOfEveryProbeInEveryBrick) {
    const auto [order, format] = GetParam();
    std::mt19937 random(7);
    const CompressedVolume volume = test::random_volume(order, false, random);
    const VolumeRelighter relighter(volume, format);
    const VolumeProbes probes = probes_of(volume.grid);
    const std::vector<glm::vec3> incident = incident_light(volume, lighting_of_probes());
    const float most =
        format == VolumeFormat::rgba16 ? 0x1p-11f : 1e-6f; // half a step; sums have a different order
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

TEST(VolumeRelighter, ComputesSunVisibility) {
    std::mt19937 random(8);
    const CompressedVolume volume = test::random_volume(3, true, random);
    const VolumeRelighter relighter(volume, VolumeFormat::rgba32);
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
        EXPECT_NEAR(number_at(relighter, VolumeFormat::rgba32, with.texels, texel, 27),
                    std::clamp(seen, 0.0f, 1.0f), 1e-4f);
        EXPECT_EQ(number_at(relighter, VolumeFormat::rgba32, without.texels, texel, 27), 0);
        EXPECT_EQ(number_at(relighter, VolumeFormat::rgba32, with.texels, texel, 0),
                  number_at(relighter, VolumeFormat::rgba32, without.texels, texel, 0));
    }
    EXPECT_GT(between, 3);
}

TEST(VolumeRelighter, GivesEachBrickSeparateTexels) {
    for (const int count : {1, 51, 52, 2601, 2602, 18000}) {
        VolumeGrid grid;
        grid.bricks.resize(static_cast<std::size_t>(count));
        const VolumeAtlas atlas = atlas_of(grid, 3);
        EXPECT_GE(atlas.bricks.x * atlas.bricks.y * atlas.bricks.z, count);
        EXPECT_LT(atlas.bricks.x * atlas.bricks.y * atlas.bricks.z, 1.1 * count + 51);
        const glm::ivec3 texels = atlas.light_texels();
        EXPECT_LE(std::max({texels.x, texels.y, texels.z}), kGuaranteedTexels);
    }
    VolumeGrid grid;
    grid.bricks.resize(60);
    const VolumeAtlas atlas = atlas_of(grid, 2);
    std::vector<std::size_t> texels;
    for (std::size_t b = 0; b < grid.bricks.size(); ++b)
        for (std::size_t i = 0; i < kBrickProbes; ++i)
            texels.push_back(atlas.texel(b, i));
    std::ranges::sort(texels);
    EXPECT_EQ(std::ranges::adjacent_find(texels), texels.end());
    EXPECT_LT(texels.back(), atlas.texels_of_plane());
}

TEST(VisibilityTexels, MarkFullyVisibleCells) {
    const VolumeGrid grid{
        .origin = glm::vec3(0), .spacing = 1, .size = {1, 1, 1}, .bricks = {{{0, 0, 0}, 0}}};
    const VolumeProbes probes = probes_of(grid);
    std::vector<ProbeVisibility> visibility(kBrickProbes, {255, 255, 255, 255, 255, 255});
    const auto seen_whole = [&](std::size_t i) {
        return visibility_texels(grid, probes, visibility)[2 * atlas_of(grid, 2).texel(0, i) + 1] >> 24;
    };
    EXPECT_EQ(seen_whole(0), 1u);
    EXPECT_EQ(seen_whole(4), 0u); // no cell is above the last corner
    visibility[1][1] = 100;       // 0.6 cells along +x from (1, 0, 0)
    EXPECT_EQ(seen_whole(0), 1u); // which is away from the first cell
    EXPECT_EQ(seen_whole(1), 0u);
}

} // namespace
} // namespace prt
