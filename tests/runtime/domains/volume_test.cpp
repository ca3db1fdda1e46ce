// Tests volumes in memory: weights of probes in closed form, and incident light.

#include "prt/core/cluster_lighting.h"
#include "prt/core/sh.h"
#include "prt/core/transfer_volume.h"
#include "runtime/domains/volume_weights.h"
#include "support/random_volume.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace prt {
namespace {

constexpr std::uint8_t kFar = 255;
constexpr ProbeVisibility kAllAround = {kFar, kFar, kFar, kFar, kFar, kFar};

/// A coarse brick, and fine ones on its side.
VolumeGrid two_levels() {
    return {
        .origin = {-1, 2, 0.5f},
        .spacing = 0.25f,
        .size = {4, 2, 2},
        .bricks = {
            {{0, 0, 0}, 1}, {{2, 0, 0}, 0}, {{2, 1, 0}, 0}, {{2, 0, 1}, 0}, {{2, 1, 1}, 0}, {{3, 0, 0}, 0}}};
}

glm::vec3 random_position(const VolumeGrid& grid, std::mt19937& random, float beyond = 0) {
    const glm::vec3 extent = grid.spacing * static_cast<float>(kBrickCells) * glm::vec3(grid.size);
    std::uniform_real_distribution<float> share(-beyond, 1 + beyond);
    return grid.origin + extent * glm::vec3(share(random), share(random), share(random));
}

float sum(const VolumeCorners& corners) {
    return std::accumulate(corners.weights.begin(), corners.weights.end(), 0.0f);
}

TEST(VolumeWeights, SumToOneForAllVisibilities) {
    std::mt19937 random(1);
    const CompressedVolume volume = test::random_volume(2, false, random, 2);
    const VolumeLookup lookup(volume.grid, volume.visibility);
    for (int i = 0; i < 2000; ++i) {
        const VolumeCorners corners = lookup.find(random_position(volume.grid, random, 0.5f),
                                                  glm::normalize(glm::vec3(1, i % 3 - 1, 0.5f)));
        EXPECT_NEAR(sum(corners), 1, 1e-5f);
        EXPECT_GE(std::ranges::min(corners.weights), 0);
    }
}

TEST(VolumeWeights, IgnoreVisibilityIfAllProbesAreHidden) {
    const VolumeGrid grid{
        .origin = glm::vec3(0), .spacing = 1, .size = {1, 1, 1}, .bricks = {{{0, 0, 0}, 0}}};
    const std::vector<ProbeVisibility> open(kBrickProbes, kAllAround),
        invalid(kBrickProbes, ProbeVisibility{});
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 position = random_position(grid, random);
        const VolumeCorners seen = VolumeLookup(grid, open).find(position),
                            hidden = VolumeLookup(grid, invalid).find(position);
        for (std::size_t c = 0; c < 8; ++c)
            EXPECT_NEAR(seen.weights[c], hidden.weights[c], 1e-5f);
    }
}

TEST(VolumeWeights, AreExactForLinearLightWithoutOcclusion) {
    const VolumeGrid grid = two_levels();
    const std::vector<ProbeVisibility> visibility(probes_of(grid).size(), kAllAround);
    const VolumeLookup lookup(grid, visibility);
    const auto linear = [](const glm::vec3& p) { return 3 + 2 * p.x - p.y + 0.5f * p.z; };
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        const glm::vec3 position = random_position(grid, random);
        const glm::vec3 bricks = (position - grid.origin) / (grid.spacing * static_cast<float>(kBrickCells));
        if (bricks.x > 3 && (bricks.y > 1 || bricks.z > 1))
            continue; // in no brick
        const VolumeCorners corners = lookup.find(position);
        float light = 0;
        for (std::size_t c = 0; c < 8; ++c)
            light +=
                corners.weights[c] * linear(position_of(grid, lookup.probes().corners[corners.probes[c]]));
        EXPECT_NEAR(light, linear(position), 2e-5f);
    }
}

TEST(VolumeWeights, UseANormalOffsetOfAQuarterCell) {
    const VolumeGrid grid = two_levels();
    const std::vector<ProbeVisibility> visibility(probes_of(grid).size(), kAllAround);
    const VolumeLookup lookup(grid, visibility);
    const glm::vec3 coarse(-0.5f, 2.5f, 1), fine(1.25f, 2.25f, 1), normal(0, 0.6f, -0.8f);
    for (const auto& [position, cell] : {std::pair(coarse, 0.5f), std::pair(fine, 0.25f)}) {
        const VolumeCorners surface = lookup.find(position, normal),
                            off = lookup.find(position + 0.25f * cell * normal);
        EXPECT_EQ(surface.probes, off.probes);
        for (std::size_t c = 0; c < 8; ++c)
            EXPECT_NEAR(surface.weights[c], off.weights[c], 1e-6f);
    }
}

TEST(VolumeWeights, ClampOutsidePositions) {
    const VolumeGrid grid{
        .origin = {1, 2, 3}, .spacing = 0.5f, .size = {2, 1, 1}, .bricks = {{{0, 0, 0}, 0}, {{1, 0, 0}, 0}}};
    const std::vector<ProbeVisibility> visibility(probes_of(grid).size(), kAllAround);
    const VolumeLookup lookup(grid, visibility);
    const VolumeCorners outside = lookup.find({9, 3, -20}), inside = lookup.find({5, 3, 3});
    EXPECT_EQ(outside.probes, inside.probes);
    EXPECT_EQ(outside.weights, inside.weights);
}

/// Sets values of hanging probes by interpolation in the coarse brick.
void interpolate_hanging(const VolumeGrid& grid, const VolumeProbes& probes, std::vector<float>& values) {
    for (const VolumeProbes::Hanging& hanging : probes.hanging) {
        const VolumeCorners corners =
            corners_in(grid, probes, hanging.brick, position_of(grid, probes.corners[hanging.probe]));
        values[hanging.probe] = 0;
        for (std::size_t c = 0; c < 8; ++c)
            values[hanging.probe] += corners.weights[c] * values[corners.probes[c]];
    }
}

TEST(VolumeWeights, AreContinuousBetweenBricksOfDifferentLevels) {
    const VolumeGrid grid = two_levels();
    const VolumeProbes probes = probes_of(grid);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> value(0, 1);
    std::vector<float> values(probes.size());
    for (float& v : values)
        v = value(random);
    interpolate_hanging(grid, probes, values);
    EXPECT_FALSE(probes.hanging.empty());
    const auto light = [&](std::size_t brick, const glm::vec3& position) {
        const VolumeCorners corners = corners_in(grid, probes, brick, position);
        float mixed = 0;
        for (std::size_t c = 0; c < 8; ++c)
            mixed += corners.weights[c] * values[corners.probes[c]];
        return mixed;
    };
    const float face = grid.origin.x + 8 * grid.spacing;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 position(face, grid.origin.y + 4 * grid.spacing * value(random),
                                 grid.origin.z + 4 * grid.spacing * value(random));
        EXPECT_NEAR(light(0, position), light(1, position), 1e-5f); // the coarse brick and {2, 0, 0}
    }
}

/// Distances of a probe from where the plane n·x = offset crosses its axes.
std::array<float, 6> distances_to_plane(const glm::vec3& n, float offset, const glm::vec3& probe) {
    std::array<float, 6> distances;
    distances.fill(1e6f);
    const float above = offset - glm::dot(n, probe); // along n
    for (int a = 0; a < 3; ++a)
        if (const float along = above / n[a]; std::isfinite(along))
            distances[static_cast<std::size_t>(2 * a + (along > 0 ? 1 : 0))] = std::abs(along);
    return distances;
}

TEST(VisibilityWeight, HidesExactlyTheOutsideOfTheBox) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> distance(0.2f, 3), share(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        std::array<float, 6> distances, nearness;
        for (std::size_t a = 0; a < 6; ++a) {
            distances[a] = distance(random);
            nearness[a] = 1 / distances[a];
        }
        // On a face of the box around the probe.
        glm::vec3 d;
        const int face = i % 3;
        for (int a = 0; a < 3; ++a) {
            const float s = a != face ? share(random) : i % 2 == 0 ? 1.0f : -1.0f;
            d[a] = s * distances[static_cast<std::size_t>(2 * a + (s > 0 ? 1 : 0))];
        }
        EXPECT_EQ(visibility_weight(nearness, d * (kVisibilityFull - 0.01f)), 1);
        EXPECT_LE(visibility_weight(nearness, d * (kVisibilityNone + 0.01f)), kHiddenWeight);
        EXPECT_NEAR(visibility_weight(nearness, d * (kVisibilityFull + kVisibilityNone) / 2.0f), 0.5f, 1e-4f);
    }
}

TEST(VolumeWeights, ExcludeProbesBehindAWall) {
    const VolumeGrid grid{
        .origin = glm::vec3(0), .spacing = 1, .size = {1, 1, 1}, .bricks = {{{0, 0, 0}, 0}}};
    const VolumeProbes probes = probes_of(grid);
    constexpr float kWall = 1.5f;
    std::vector<ProbeVisibility> visibility;
    for (const glm::ivec3& corner : probes.corners)
        visibility.push_back(
            visibility_of(distances_to_plane({1, 0, 0}, kWall, glm::vec3(corner)), grid.spacing));
    const VolumeLookup lookup(grid, visibility);
    for (const float x : {1.0f, 1.3f, 1.7f, 1.95f}) {
        const VolumeCorners corners = lookup.find({x, 1.25f, 2.5f});
        float leaked = 0;
        for (std::size_t c = 0; c < 8; ++c)
            if ((static_cast<float>(probes.corners[corners.probes[c]].x) < kWall) != (x < kWall))
                leaked += corners.weights[c];
        EXPECT_LT(leaked, 2e-3f) << x;
    }
}

TEST(ProbeVisibility, MeasuresDistancesToHalfAStep) {
    for (const float cell : {0.25f, 3.0f})
        for (float share = 0; share <= 1; share += 0.01f) {
            const float distance = kVisibilityCells * cell * share;
            std::array<float, 6> distances;
            distances.fill(distance);
            const std::array<float, 6> again = distances_of(visibility_of(distances, cell), cell);
            for (const float d : again)
                EXPECT_NEAR(std::sqrt(d / (kVisibilityCells * cell)), std::sqrt(share), 0.5001f / 255);
            EXPECT_EQ(visibility_of(again, cell), visibility_of(distances, cell));
        }
    std::array<float, 6> far;
    far.fill(1e9f);
    EXPECT_EQ(visibility_of(far, 1), kAllAround);
}

TEST(IncidentLight, MatchesTheDecodedTransfer) {
    for (const int order : {2, 3, 4}) {
        std::mt19937 random(6);
        const CompressedVolume volume = test::random_volume(order, false, random);
        Lighting lighting{cone_light(3, {0, 1, 0}, 0.7, {1, 2, 3}), cone_light(3, {1, 0, 0}, 0.2, {3, 2, 1})};
        lighting.lamps = {{0.5f, 1, 2}};
        const TransferLayout of_one = volume.compressed.transfer.bases.layout.of_one_output();
        const std::vector<glm::vec3> columns = light_columns(of_one, lighting);
        const Transfer transfer = decode(volume.compressed.transfer);
        const std::vector<glm::vec3> incident = incident_light(volume, lighting);
        const std::size_t size = of_one.dimension();
        ASSERT_EQ(incident.size() * size, transfer.vectors.size());
        for (std::size_t i = 0; i < incident.size(); ++i) {
            glm::vec3 expected(0);
            const float* numbers = &transfer.vectors[i * size];
            const glm::vec3* color = columns.data();
            for (const TransferTerm& term : of_one.terms) {
                const std::size_t count = of_one.columns_of(term);
                for (int c = 0; c < 3; ++c)
                    for (std::size_t n = 0; n < count; ++n)
                        expected[c] +=
                            numbers[(term.channels == 1 ? 0 : static_cast<std::size_t>(c)) * count + n] *
                            color[n][c];
                numbers += of_one.numbers_of(term);
                color += count;
            }
            EXPECT_LT(glm::distance(incident[i], expected), 1e-4f * std::max(1.0f, glm::length(expected)));
        }
    }
}

TEST(Irradiance, MatchesUniformAndCosineLight) {
    for (const int order : {2, 3, 4}) {
        const Light sky = constant_light(order, {1, 2, 3});
        EXPECT_LT(glm::distance(irradiance_of(sky.coefficients, {0, 0.6f, 0.8f}), {1, 2, 3}), 1e-5f);
    }
    // The clamped cosine to +y: 2/3 of it on receivers facing +y, from band 1.
    std::vector<glm::vec3> cosine(4, glm::vec3(0));
    cosine[1] = glm::vec3(-1 / 0.48860251f); // radiance y
    EXPECT_NEAR(irradiance_of(cosine, {0, 1, 0}).x, 2.0f / 3, 1e-5f);
    EXPECT_EQ(irradiance_of(cosine, {0, -1, 0}).x, 0);
}

TEST(VolumeAtlas, GivesEachBrickSeparateTexels) {
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
