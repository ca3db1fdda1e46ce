// Tests the picture of the error over the surface, and the light of its budget.

#include "core/budget_work.h"

#include "compress/study/receiver_colors.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

/// Returns a floor and a separate ball; triangles share no vertices.
std::shared_ptr<const Model> floor_and_ball() {
    return make_model(prt::test::SceneBuilder().floor({0, -0.5f, 0}, 1, 6).sphere({0, 3, 0}, 0.5f, 6).build(),
                      "ball.glb");
}

/// Returns the points for which `keep` is true.
template <class Keep>
prt::SurfacePoints kept(const prt::SurfacePoints& points, Keep&& keep) {
    prt::SurfacePoints some;
    for (std::size_t p = 0; p < points.size(); ++p)
        if (keep(p)) {
            some.receivers.areas.push_back(points.receivers.areas[p]);
            some.triangles.push_back(points.triangles[p]);
            some.uv.push_back(points.uv[p]);
            some.corners.push_back(points.corners[p]);
        }
    return some;
}

TEST(SurfaceErrorColors, EqualErrorsHaveOneColor) {
    const auto model = floor_and_ball();
    const prt::SurfacePoints points = prt::surface_points(*model->trace, {.count = 8192, .threads = 2});
    const double error = 0.1, norm = 4;
    const std::vector<double> squared(points.size(), error * error * norm);
    const glm::vec3 wanted = prt::heat_color(error / kWhiteSurfaceError);
    for (const glm::vec3& color : surface_error_colors(*model, points, squared, norm))
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(color[c], wanted[c], 1e-5f);
}

TEST(SurfaceErrorColors, AreMeansOfPointsAroundAVertex) {
    const auto model = floor_and_ball();
    const prt::SurfacePoints points = prt::surface_points(*model->trace, {.count = 4096, .threads = 2});
    std::vector<double> squared;
    for (std::size_t p = 0; p < points.size(); ++p)
        squared.push_back(points.receivers.positions[p].x > 0 ? 0.02 : -0.01); // estimates may be negative
    const auto colors = surface_error_colors(*model, points, squared, 1);
    const prt::VertexArray& vertices = model->scene.vertex_arrays[0];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (std::abs(vertices.positions[i].x) < 0.4f) // a quad of the floor is a third wide
            continue;
        const double error = vertices.positions[i].x > 0 ? std::sqrt(0.02) : 0;
        EXPECT_NEAR(colors[vertices.first_receiver + i].r, prt::heat_color(error / kWhiteSurfaceError).r,
                    1e-4f);
    }
}

TEST(SurfaceErrorColors, SpreadAlongEdgesAndLeaveIsolatedVerticesBlue) {
    prt::Scene scene = prt::test::SceneBuilder().floor({0, 0, 0}, 1).build();
    scene.primitives[0].triangles[1] = {0, 2, 5}; // shares an edge; 3 and 4 are of no triangle then
    const auto model = make_model(std::move(scene), "floor.glb");
    const prt::SurfacePoints all = prt::surface_points(*model->trace, {.count = 64, .threads = 2});
    const prt::SurfacePoints one = kept(all, [](std::size_t p) { return p == 0; });
    const std::vector<double> squared = {0.01};
    const auto colors = surface_error_colors(*model, one, squared, 1);
    const glm::vec3 error = prt::heat_color(0.1 / kWhiteSurfaceError);
    for (const std::size_t joined : {0, 1, 2, 5})
        EXPECT_NEAR(colors[joined].r, error.r, 1e-4f);
    for (const std::size_t separate : {3, 4})
        EXPECT_GT(colors[separate].b, colors[separate].r);
}

} // namespace
} // namespace viewer
