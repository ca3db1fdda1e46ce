#include "prt/error_measures.h"

#include "prt/error.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

TEST(RelativeL2, WeightsByArea) {
    const Transfer a{1, 1, {1, 2}}, b{1, 1, {1.5f, 2}};
    // sqrt(3 · 0.25 / (3 · 1 + 1 · 4))
    EXPECT_NEAR(relative_l2(a, b, std::vector<float>{3, 1}), std::sqrt(0.75 / 7), 1e-7);
    EXPECT_EQ(relative_l2(a, a, std::vector<float>{3, 1}), 0);
    EXPECT_EQ(relative_l2(a, b, std::vector<float>{0, 1}), 0);
}

TEST(RelativeL2, ComparesGreyWithColour) {
    const Transfer grey{1, 1, {2}}, coloured{1, 3, {2, 2, 3}};
    EXPECT_NEAR(relative_l2(grey, coloured, std::vector<float>{1}), std::sqrt(1.0 / 12), 1e-7);
}

TEST(RelativeL2, DifferentShapesAreRefused) {
    EXPECT_THROW(relative_l2({1, 1, {2}}, {1, 1, {2, 3}}, std::vector<float>{1}), Error);
    EXPECT_THROW(relative_l2({1, 1, {1, 2, 3, 4}}, {2, 1, {1, 2, 3, 4}}, std::vector<float>(4, 1)), Error);
}

TEST(LitError, HasTheDefinedMeasures) {
    // A square of two triangles, receivers 0..5; the two in the second triangle lie in another cluster. Its
    // corners are not shared, so no edge crosses; then one that does.
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

} // namespace
} // namespace prt
