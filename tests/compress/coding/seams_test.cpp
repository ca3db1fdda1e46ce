// Tests seams between clusters and between charts.

#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "runtime/load/mesh_edges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

/// A grid whose transfer rotates smoothly: clusters are patches, and every patch has borders.
struct Grid {
    static constexpr std::uint32_t kSize = 60;
    Transfer transfer = zero_transfer(3, 1, kSize* kSize);
    std::vector<float> areas = std::vector<float>(kSize * kSize, 1.0f);
    std::vector<Edge> edges;

    Grid() {
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const std::uint32_t p = y * kSize + x;
                for (std::uint32_t i = 0; i < 9; ++i) {
                    const std::uint32_t along = (1 + i % 3) * x + (1 + i / 3) * y;
                    transfer.vector(p)[i] =
                        (i == 0 ? 2.0f : 0.0f) +
                        std::sin(0.05f * static_cast<float>(along) + static_cast<float>(i * i));
                }
                if (x + 1 < kSize)
                    edges.push_back({p, p + 1});
                if (y + 1 < kSize)
                    edges.push_back({p, p + kSize});
            }
    }

    /// Jumps of the error of a coefficient along edges, squared.
    struct Jumps {
        double squared = 0;
        double lit_rms = 0;
    };
    Jumps compressed(double seam_weight, WeightFormat format) const {
        CompressOptions options;
        options.clusters = 30;
        options.coding.components = 2;
        options.coding.bits = 12;
        options.coding.format = format;
        options.seam_weight = seam_weight;
        options.metric = natural_metric(transfer.layout); // which jumps are measured in
        const CompressResult result = compress(transfer, {areas, edges}, options);
        const Transfer decoded = decode(result.transfer);
        Jumps jumps;
        for (const Edge& e : edges)
            for (std::size_t i = 0; i < 9; ++i)
                jumps.squared += std::pow(static_cast<double>(
                                              (decoded.vector(e.first)[i] - transfer.vector(e.first)[i]) -
                                              (decoded.vector(e.second)[i] - transfer.vector(e.second)[i])),
                                          2) *
                                 (i == 0 ? 1.0 : 0.25 / std::floor(std::sqrt(static_cast<double>(i))));
        jumps.lit_rms = result.statistics.lit_rms;
        return jumps;
    }
};

class Seams : public testing::TestWithParam<WeightFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, Seams, testing::Values(WeightFormat::packed, WeightFormat::float32));

TEST_P(Seams, SmoothingLowersTheJumpsAndRaisesTheErrorALittle) {
    const Grid grid;
    const Grid::Jumps without = grid.compressed(0, GetParam()), with = grid.compressed(0.5, GetParam());
    EXPECT_LT(with.squared, 0.9 * without.squared);
    EXPECT_LT(with.lit_rms, 1.2 * without.lit_rms);
    EXPECT_GE(with.lit_rms, without.lit_rms);
}

TEST_P(Seams, SmoothingKeepsTheMeanNumberOfComponents) {
    const Grid grid;
    CompressOptions options;
    options.clusters = 30;
    options.coding.components = 6;
    options.mean_components = 1.5; // some have one, others two or more: reassignment would like the latter
    options.coding.bits = 48;
    options.coding.format = GetParam();
    options.seam_weight = 4;
    const CompressResult result = compress(grid.transfer, {grid.areas, grid.edges}, options);
    EXPECT_LE(result.statistics.mean_components, 1.5);
    EXPECT_GT(result.statistics.mean_components, 1.2);
}

/// Two adjacent charts that show one position, with an offset of half a texel.
struct TwoCharts : Grid {
    static constexpr std::uint32_t kWidth = kSize / 2;
    std::vector<SeamJump> jumps;

    TwoCharts() {
        std::erase_if(edges,
                      [](const Edge& e) { return e.second == e.first + 1 && e.second % kSize == kWidth; });
        for (std::uint32_t y = 0; y < kSize; ++y)
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const double u = x < kWidth ? x : x - kWidth + 0.5;
                for (std::uint32_t i = 0; i < 9; ++i) {
                    const int of_y = 1 + i / 3;
                    const double along = (1 + i % 3) * u + of_y * y;
                    transfer.vector(y * kSize + x)[i] =
                        (i == 0 ? 2.0f : 0.0f) + static_cast<float>(std::sin(0.05 * along + i * i));
                }
            }
        // Both sides of a seam along u = 5.25.
        for (std::uint32_t p = 5; p < kSize * kSize; p += kSize)
            jumps.push_back({{p, p + 1, p, p, p + 29, p + 30, p, p}, {0.75f, 0.25f, 0, 0, -0.25f, -0.75f}});
    }

    struct Closed {
        double jump = 0, lit_rms = 0;
    };
    Closed compressed(std::span<const SeamJump> closed) const {
        CompressOptions options{.clusters = 30, .coding = {.components = 3, .bits = 15}};
        options.metric = natural_metric(transfer.layout);
        const CompressResult result =
            compress(transfer, {.areas = areas, .edges = edges, .jumps = closed}, options);
        const Transfer decoded = decode(result.transfer);
        double sum = 0;
        for (const SeamJump& jump : jumps)
            for (std::size_t i = 0; i < 9; ++i) {
                double error = 0;
                for (std::size_t k = 0; k < 8; ++k)
                    error += static_cast<double>(jump.weights[k] * (decoded.vector(jump.receivers[k])[i] -
                                                                    transfer.vector(jump.receivers[k])[i]));
                sum += error * error;
            }
        return {std::sqrt(sum), result.statistics.lit_rms};
    }
};

TEST(Seams, LightmapSeamsAreClosed) {
    const TwoCharts charts;
    const TwoCharts::Closed open = charts.compressed({}), closed = charts.compressed(charts.jumps);
    EXPECT_LT(closed.jump, 0.7 * open.jump);
    EXPECT_LT(closed.lit_rms, 1.05 * open.lit_rms);
}

TEST(Seams, MissingReceiversAreRejected) {
    const Grid grid;
    const SeamJump jump{{0, 1, 2, 3, 4, 5, 6, Grid::kSize * Grid::kSize}, {1}};
    EXPECT_THROW(compress(grid.transfer, {.areas = grid.areas, .jumps = {&jump, 1}}, {}), Error);
}

TEST(Seams, MeshEdgesAreUniqueTriangleEdges) {
    Scene scene;
    scene.vertex_arrays.resize(2);
    scene.vertex_arrays[0].positions.resize(4);
    scene.vertex_arrays[1].positions.resize(3);
    scene.vertex_arrays[1].first_receiver = 4;
    scene.primitives.resize(2);
    scene.primitives[0].triangles = {{0, 1, 2}, {2, 1, 3}};
    scene.primitives[1].vertices = 1;
    scene.primitives[1].triangles = {{0, 1, 2}, {1, 1, 2}};
    EXPECT_EQ(mesh_edges(scene),
              (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {4, 5}, {4, 6}, {5, 6}}));
}

} // namespace
} // namespace prt
