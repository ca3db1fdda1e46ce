// Tests the error measures of lit transfer.

#include "prt/core/error_measures.h"

#include "prt/core/error.h"
#include "runtime/load/mesh_edges.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

TEST(RelativeL2, WeightsByArea) {
    const TransferLayout layout = layout_of_one(1, 1);
    const Transfer a{layout, {1, 2}}, b{layout, {1.5f, 2}};
    // sqrt(3 · 0.25 / (3 · 1 + 1 · 4))
    EXPECT_NEAR(relative_l2(a, b, std::vector<float>{3, 1}), std::sqrt(0.75 / 7), 1e-7);
    EXPECT_EQ(relative_l2(a, a, std::vector<float>{3, 1}), 0);
    EXPECT_EQ(relative_l2(a, b, std::vector<float>{0, 1}), 0);
}

TEST(RelativeL2, ComparesGreyWithColour) {
    const Transfer grey{layout_of_one(1, 1), {2}}, coloured{layout_of_one(1, 3), {2, 2, 3}};
    EXPECT_NEAR(relative_l2(grey, coloured, std::vector<float>{1}), std::sqrt(1.0 / 12), 1e-7);
}

TEST(TransferContrast, IsOverTheTransferOfEachReceiver) {
    const Transfer a{layout_of_one(1, 1), {1, 4, 0.25f}}, b{layout_of_one(1, 1), {1.1f, 3, 0.25f}};
    const std::vector<float> areas = {2, 1, 1}; // the logarithmic mean is 1
    EXPECT_NEAR(transfer_contrast(a, b, areas),
                std::sqrt(0.5 * std::pow(0.1 / 1.1, 2) + 0.25 * std::pow(1 / 4.1, 2)), 1e-6);
    EXPECT_EQ(transfer_contrast(a, a, areas), 0);
}

TEST(RelativeL2, DifferentShapesAreRejected) {
    const Transfer one = zero_transfer(1, 1, 1);
    EXPECT_THROW(relative_l2(one, zero_transfer(1, 1, 2), std::vector<float>{1}), Error);
    EXPECT_THROW(relative_l2(zero_transfer(1, 1, 4), zero_transfer(2, 1, 4), std::vector<float>(4, 1)),
                 Error);
}

TEST(RelativeL2, ComparesOtherTermsCombined) {
    const Transfer both{{1, {{TermKind::direct, 1}, {TermKind::indirect, 3}}}, {1, 1, 2, 3}};
    const Transfer direct{layout_of_one(1, 1, TermKind::direct), {2}}, whole{layout_of_one(1, 3), {2, 3, 5}};
    EXPECT_NEAR(relative_l2(both, whole, std::vector<float>{1}), std::sqrt(1.0 / (4 + 9 + 16)), 1e-7);
    EXPECT_NEAR(relative_l2(both, direct, std::vector<float>{1}), std::sqrt((1.0 + 4) / (4 + 9 + 16)), 1e-7);
}

TEST(LitError, HasTheDefinedMeasures) {
    // A square of two triangles, receivers 0..5; the two in the second triangle have a different cluster. Its
    // corners are not shared, so no edge crosses clusters; then with an edge that does.
    Scene scene = test::SceneBuilder().quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).build();
    const std::vector<float> areas(6, 1.0f);
    const std::vector<glm::vec3> reference(6, glm::vec3(2)),
        approximation = {glm::vec3(2), glm::vec3(2.1f, 2, 2), glm::vec3(2),
                         glm::vec3(2), glm::vec3(1.7f),       glm::vec3(2)};
    std::vector<std::uint16_t> clusters = {0, 0, 0, 1, 1, 1};
    LitError error = lit_error(reference, approximation, areas, mesh_edges(scene), clusters);
    EXPECT_NEAR(error.rms, std::sqrt((0.01 + 3 * 0.09) / (6 * 12)), 1e-6);
    EXPECT_NEAR(error.max, 0.3 / 2, 1e-6);
    EXPECT_NEAR(error.mean, 2, 1e-9);
    EXPECT_EQ(error.crossing.edges, 0u);
    EXPECT_EQ(error.inner.edges, 6u);
    clusters[5] = 0; // now the edges 4-5 and 5-3 cross
    error = lit_error(reference, approximation, areas, mesh_edges(scene), clusters);
    EXPECT_EQ(error.crossing.edges, 2u);
    EXPECT_NEAR(error.crossing.max, 0.3 / 2, 1e-6);
    EXPECT_NEAR(error.crossing.rms, std::sqrt(0.09 / 2) / 2, 1e-6);
    EXPECT_EQ(error.crossing.worst, (Edge{4, 5}));
    EXPECT_NEAR(error.inner.max, 0.3 / 2, 1e-6); // 3-4
}

TEST(LitError, UsesTheGivenScaleInTheDark) {
    // A sun below the floor: nothing is lit, and an error of a thousandth is infinite relative to the light.
    const std::vector<float> areas = {1, 3};
    const std::vector<glm::vec3> dark(2, glm::vec3(0)), lit = {glm::vec3(2), glm::vec3(0.4f)},
                                                        error(2, glm::vec3(0.001f));
    EXPECT_TRUE(std::isinf(lit_error(dark, error, areas, {}, std::nullopt).rms));
    const LitScale scale = lit_scale(lit, areas);
    EXPECT_NEAR(scale.mean_square, (3 * 4.0 + 3 * 3 * 0.16) / 4, 1e-6);
    EXPECT_NEAR(scale.mean, (2 + 3 * 0.4) / 4, 1e-6);
    const LitError found = lit_error(dark, error, areas, {}, std::nullopt, scale);
    EXPECT_NEAR(found.rms, std::sqrt(3e-6 / scale.mean_square), 1e-9);
    EXPECT_NEAR(found.max, 0.001 / scale.mean, 1e-8);
    EXPECT_EQ(found.mean, 0);
}

TEST(LitError, IsRelativeToTheLocalLight) {
    // Five decades: every receiver has an error of a tenth of its light, and the darkest one the error of the
    // brightest.
    std::vector<glm::vec3> reference, approximation;
    std::vector<float> areas;
    double logarithms = 0;
    for (int p = 0; p < 100; ++p) {
        const float y = std::pow(10.0f, 0.049f * static_cast<float>(p) - 3);
        reference.emplace_back(y);
        approximation.emplace_back(1.1f * y);
        areas.push_back(p < 50 ? 3.0f : 1.0f);
        logarithms += static_cast<double>(areas.back()) * std::log(static_cast<double>(y)) / 200;
    }
    const double a = 0.1 * std::exp(logarithms);
    const auto contrast = [&](std::size_t p) {
        const double y = static_cast<double>(reference[p].x);
        return 0.1 * y / (y + a);
    };
    const std::vector<Edge> edges = {{10, 11}, {50, 49}};
    VisibleError seen = lit_error(reference, approximation, areas, edges, std::nullopt).visible;
    EXPECT_NEAR(seen.adaptation, a, 1e-5 * a);
    EXPECT_NEAR(seen.percentile_95, contrast(89), 1e-5); // 50 receivers of three, and 40 of one: 95 %
    EXPECT_NEAR(seen.percentile_99, contrast(97), 1e-5);
    EXPECT_NEAR(seen.jumps_99, contrast(11) - contrast(10), 1e-5); // its ends have 6 of the area of 10
    approximation[0] += approximation[99];
    seen = lit_error(reference, approximation, areas, {}, std::nullopt).visible;
    EXPECT_GT(seen.rms, 1000);
    EXPECT_NEAR(
        seen.area_above_5_percent,
        3.0 / 200 +
            [&] {
                double area = 0;
                for (std::size_t p = 1; p < 100; ++p)
                    area += contrast(p) > 0.05 ? static_cast<double>(areas[p]) / 200 : 0;
                return area;
            }(),
        1e-9);
}

TEST(LitError, CountsColorsByLuminance) {
    const std::vector<float> areas = {1};
    const std::vector<glm::vec3> grey = {glm::vec3(1)}, blue = {glm::vec3(1, 1, 2)};
    const VisibleError seen = lit_error(grey, blue, areas, {}, std::nullopt).visible;
    EXPECT_NEAR(seen.adaptation, 0.1, 1e-6);
    EXPECT_NEAR(seen.mean, std::sqrt(0.0722) / 1.1, 1e-6);
}

TEST(LitError, DarkerHalfUsesTheSumOfChannels) {
    // Two receivers, one of 10 in one channel, the other of 2 in the next; both err by 1.
    for (const int channel : {0, 1, 2})
        for (const std::size_t bright : {0, 1}) {
            std::vector<glm::vec3> reference(2, glm::vec3(0));
            reference[bright][channel] = 10;
            reference[1 - bright][(channel + 1) % 3] = 2;
            std::vector<glm::vec3> approximation = reference;
            for (glm::vec3& r : approximation)
                r.y += 1;
            EXPECT_NEAR(lit_error(reference, approximation, std::vector<float>{1, 1}, {}, std::nullopt)
                            .darker_half_rms,
                        0.5, 1e-6)
                << channel << " " << bright;
        }
}

} // namespace
} // namespace prt
