// Tests the figure of example_scenes: its size, and that its feet do not slide on the passing ground.

#include "prt/gltf/animation.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace prt {
namespace {

constexpr double kOnGround =
    0.0015; ///< metres: a lower vertex bears weight; a vertex that leaves the ground is higher one step later

AnimatedScene figure() {
    const test::TemporaryFolder folder;
    std::string command = PRT_EXAMPLE_SCENES " '";
    command.append(folder.path().string()).append("' figure >/dev/null");
    EXPECT_EQ(std::system(command.c_str()), 0);
    return AnimatedScene(load_gltf(folder / "figure.glb"));
}

const Animation& walk_of(const AnimatedScene& scene) {
    return *std::ranges::find(scene.animations(), "walk", &Animation::name);
}

/// All vertices at a time of a movement.
std::vector<glm::vec3> positions_of(const AnimatedScene& scene, const Animation& movement, double seconds) {
    const Scene posed =
        scene.posed(scene.pose(movement, std::fmod(seconds, movement.duration)), glm::dmat4(1));
    std::vector<glm::vec3> points;
    for (const VertexArray& vertices : posed.vertex_arrays)
        points.insert(points.end(), vertices.positions.begin(), vertices.positions.end());
    return points;
}

std::vector<glm::vec3> positions_at(const AnimatedScene& scene, double seconds) {
    return positions_of(scene, walk_of(scene), seconds);
}

TEST(ExampleFigure, HasHumanSize) {
    const AnimatedScene scene = figure();
    const Bounds box = bounds(scene.scene());
    EXPECT_NEAR(box.high.y - box.low.y, 1.8, 0.02);
    EXPECT_NEAR(scene.scene().world(box.low).y, 0, 1e-3);
    EXPECT_TRUE(scene.scene().receivers() >= 3000 && scene.scene().receivers() <= 6000)
        << scene.scene().receivers();
    ASSERT_EQ(scene.skins().size(), 1u);
    EXPECT_TRUE(scene.skins()[0].joints.size() >= 15 && scene.skins()[0].joints.size() <= 20);
    EXPECT_NE(std::ranges::find(scene.animations(), "idle", &Animation::name), scene.animations().end());
}

TEST(ExampleFigure, ItsFeetDoNotSlideAndItsWalkLoops) {
    const AnimatedScene scene = figure();
    const Animation& walk = walk_of(scene);
    ASSERT_GT(walk.speed, 1);
    constexpr int kSteps = 220;
    const double step = walk.duration / kSteps;
    std::vector<glm::vec3> before = positions_at(scene, 0);
    for (int i = 1; i <= kSteps; ++i) {
        const std::vector<glm::vec3> now = positions_at(scene, i * step);
        std::size_t bearing = 0;
        double lowest = 1;
        for (std::size_t v = 0; v < now.size(); ++v) {
            lowest = std::min<double>(lowest, now[v].y);
            if (before[v].y > kOnGround || now[v].y > kOnGround)
                continue;
            ++bearing;
            // The ground passes by 5.75 mm; a rolling foot rotates about its contact point.
            EXPECT_NEAR(now[v].z - before[v].z, -walk.speed * step, 1e-3) << i;
            EXPECT_NEAR(now[v].x, before[v].x, 1e-3) << i;
        }
        EXPECT_GT(bearing, 0u) << i;
        EXPECT_GT(lowest, -4 * kOnGround) << i; // soles are of a mesh, and bend at the toes
        before = now;
    }
    const auto first = positions_at(scene, 0), last = positions_at(scene, walk.duration - 1e-9);
    for (std::size_t v = 0; v < first.size(); ++v)
        ASSERT_LT(glm::distance(first[v], last[v]), 1e-5f);
}

TEST(ExampleFigure, ItsDanceLoopsOnTheGround) {
    const AnimatedScene scene = figure();
    const auto dance = std::ranges::find(scene.animations(), "dance", &Animation::name);
    ASSERT_NE(dance, scene.animations().end());
    EXPECT_DOUBLE_EQ(dance->duration, 2); // 60 frames at 30 in a second
    const std::vector<glm::vec3> first = positions_of(scene, *dance, 0);
    float moved = 0;
    for (int i = 0; i < 20; ++i) {
        const std::vector<glm::vec3> now = positions_of(scene, *dance, 0.1 * i);
        float lowest = 1;
        for (std::size_t v = 0; v < now.size(); ++v) {
            lowest = std::min(lowest, now[v].y);
            moved = std::max(moved, glm::distance(now[v], first[v]));
        }
        EXPECT_NEAR(lowest, 0, 0.01f) << i; // a foot is on the ground at all times
    }
    EXPECT_GT(moved, 0.8f); // hands go from the thighs to above the head
    const std::vector<glm::vec3> last = positions_of(scene, *dance, dance->duration - 1e-6);
    for (std::size_t v = 0; v < first.size(); ++v)
        ASSERT_LT(glm::distance(first[v], last[v]), 1e-4f);
}

} // namespace
} // namespace prt
