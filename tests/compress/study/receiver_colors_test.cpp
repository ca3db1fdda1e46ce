// Tests colors that show clusters and errors of receivers.

#include "compress/study/receiver_colors.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

/// Black, red, yellow and white, and no more beyond.
TEST(ReceiverColors, HeatColorsPassThroughRedAndYellow) {
    const auto expect = [](double share, const glm::vec3& color) {
        EXPECT_LT(glm::distance(heat_color(share), color), 1e-6f) << share;
    };
    expect(0, {0, 0, 0});
    expect(1.0 / 6, {0.5f, 0, 0});
    expect(1.0 / 3, {1, 0, 0});
    expect(0.5, {1, 0.5f, 0});
    expect(2.0 / 3, {1, 1, 0});
    expect(5.0 / 6, {1, 1, 0.5f});
    expect(1, {1, 1, 1});
    expect(7, {1, 1, 1});
}

TEST(ReceiverColors, AdjacentNumbersHaveDistinctColors) {
    constexpr std::size_t kLabels = 256;
    for (std::size_t a = 0; a < kLabels; ++a) {
        const glm::vec3 color = label_color(a);
        for (int c = 0; c < 3; ++c) {
            EXPECT_GT(color[c], 0);
            EXPECT_LT(color[c], 1);
        }
        EXPECT_GT(glm::distance(color, label_color(a + 1)), 0.3f) << a;
        for (std::size_t b = 0; b < a; ++b)
            EXPECT_GT(glm::distance(color, label_color(b)), 0.003f) << a << " " << b;
    }
}

TEST(ReceiverColors, ClustersHaveLabelColorsAndComponentsHeatColors) {
    ClusteredTransfer transfer;
    transfer.bases.components = {0, 4, 1};
    transfer.receivers.clusters = {2, 0, 1};
    EXPECT_EQ(cluster_colors(transfer), (std::vector{label_color(2), label_color(0), label_color(1)}));
    EXPECT_EQ(component_colors(transfer), (std::vector{heat_color(0.25), heat_color(0), heat_color(1)}));
    transfer.bases.components = {0, 0, 0};
    EXPECT_EQ(component_colors(transfer), std::vector(3, glm::vec3(0)));
}

/// Luminance of 2 on a quarter and of 6 on three quarters of the area.
struct ColoredMesh {
    std::vector<float> areas = {1, 3, 0, 0};
    std::vector<glm::vec3> reference = {glm::vec3(2), glm::vec3(6), glm::vec3(4), glm::vec3(4)};
    std::vector<glm::vec3> approximation = reference;
};

void expect_colors(const std::vector<glm::vec3>& colors, const std::vector<glm::vec3>& expected) {
    ASSERT_EQ(colors.size(), expected.size());
    for (std::size_t p = 0; p < colors.size(); ++p)
        EXPECT_LT(glm::distance(colors[p], expected[p]), 1e-4f) << p;
}

/// A tenth of the logarithmic mean over the area.
const double kAdaptation = 0.1 * std::exp((std::log(2) + 3 * std::log(6)) / 4);

TEST(ReceiverColors, ErrorsShowAdaptedContrast) {
    ColoredMesh mesh;
    mesh.approximation[0] += glm::vec3(0.125f, -0.25f, 0);
    mesh.approximation[1] -= glm::vec3(0, 0.1f, 5);
    const double first = std::sqrt(0.2126 * 0.125 * 0.125 + 0.7152 * 0.25 * 0.25) / (2 + kAdaptation);
    expect_colors(error_colors(mesh.reference, mesh.approximation, mesh.areas),
                  {heat_color(first / kWhiteError), glm::vec3(1), glm::vec3(0), glm::vec3(0)});
    const std::vector<glm::vec3> dark(4, glm::vec3(0)); // any light has an infinite contrast to zero
    expect_colors(error_colors(dark, mesh.approximation, mesh.areas), std::vector(4, glm::vec3(1)));
    expect_colors(error_colors(dark, dark, mesh.areas), dark);
}

TEST(ReceiverColors, SeamsShowTheLargestJumpToAnotherCluster) {
    ColoredMesh mesh;
    mesh.approximation[0] += glm::vec3(0.05f, 0, 0);
    mesh.approximation[1] -= glm::vec3(0.05f, 0, 0.01f);
    mesh.approximation[3] += glm::vec3(9);
    // 1 and 2 jump by less than 0 and 1; 2 and 3 are in one cluster.
    const std::vector<Edge> edges = {{0, 1}, {1, 2}, {2, 3}};
    const std::vector<std::uint16_t> clusters = {0, 1, 2, 2};
    const double second = (0.2126 * 0.05 + 0.0722 * 0.01) / (6 + kAdaptation),
                 jump = 0.2126 * 0.05 / (2 + kAdaptation) + second;
    expect_colors(seam_colors(mesh.reference, mesh.approximation, mesh.areas, edges, clusters),
                  {heat_color(jump / kWhiteSeam), heat_color(jump / kWhiteSeam),
                   heat_color(second / kWhiteSeam), glm::vec3(0.01f, 0.02f, 0.08f)});
    const std::vector<glm::vec3> dark(4, glm::vec3(0));
    EXPECT_EQ(seam_colors(dark, dark, mesh.areas, edges, clusters)[0], glm::vec3(0));
}

} // namespace
} // namespace prt
