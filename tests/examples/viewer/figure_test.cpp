// Tests a figure that walks through the scene, and its light.

#include "core/ground.h"
#include "core/viewer.h"
#include "gpu/offscreen.h"
#include "pictures/joined_scene.h"
#include "script/script.h"

#include "bake/gltf/encode_glb.h"
#include "prt/bake/bake.h"
#include "prt/bake/volume_bake.h"
#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/gl/gl_context.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

namespace viewer {
namespace {

using prt::test::GlbFile;
using prt::test::SceneBuilder;

constexpr int kFigureWidth = 160, kFigureHeight = 90;
constexpr float kBallRadius = 0.4f; ///< the figure is a ball on the floor

/// A floor of 6 m, and a wall along its -x side.
prt::Scene floor_and_wall() {
    return SceneBuilder()
        .floor({0, 0, 0}, 3, 12)
        .quad({-3, 0, 3}, {-3, 0, -3}, {-3, 2, -3}, {-3, 2, 3})
        .build();
}

/// Returns a grey ball that rotates once per second; `bad` breaks its animation.
GlbFile ball_figure(bool bad = false) {
    GlbFile file = prt::test::scene_file(prt::test::painted(
        SceneBuilder().sphere({0, kBallRadius, 0}, kBallRadius, 24).build(), glm::vec3(0.6f)));
    const float end = bad ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
    const auto times = file.accessor(std::vector<float>{0, 0.5f, end}, prt::test::kFloat, "SCALAR", 1),
               rotations = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, -1},
                                         prt::test::kFloat, "VEC4", 4);
    file.json["animations"] = {
        {{"name", "walk"},
         {"samplers", {{{"input", times}, {"output", rotations}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
         {"extras", {{"speed", 1.5}}}}};
    return file;
}

/// Returns a scene with compressed transfer of this order, at vertices and in a volume, so that the viewer
/// does not bake or compress.
std::vector<std::byte> shipped_scene(int order, std::size_t probes, int rays) {
    const std::string bare = prt::test::scene_file(floor_and_wall()).bytes();
    prt::GltfDocument document = prt::parse_gltf(std::as_bytes(std::span(bare)), "scene.glb");
    const prt::Scene scene = prt::extract_scene(document);
    prt::BakeOptions options;
    options.order = order;
    options.rays = rays;
    options.bounces = 3;
    const prt::BakedVolume volume = prt::bake_volume(scene, {.probes = probes}, options).volume;
    prt::CompressOptions compress;
    compress.coding = prt::preset_volume();
    compress.clusters = static_cast<int>(probes / 200);
    const prt::BakedTransfer baked = prt::bake(scene, options).baked;
    prt::write_clustered(
        document, scene,
        {prt::compress(baked.transfer, {prt::receiver_areas(scene)}, compress).transfer, baked.record});
    prt::write_volume(document, scene, prt::compress_volume(volume, compress).volume);
    return prt::encode_glb(document);
}

class FigureTest : public testing::Test {
protected:
    static void SetUpTestSuite() { shipped_ = shipped_scene(3, 800, 64); }
    void SetUp() override {
        context = prt::GlContext::create(prt::GlDevice::any);
        ASSERT_TRUE(context);
        viewer = std::make_unique<Viewer>();
        screen = std::make_unique<Offscreen>(kFigureWidth, kFigureHeight);
        viewer->settings.panels = false;
        prt::test::glb_of(shipped_).write(folder / "scene.glb");
        ball_figure().write(folder / "ball.glb");
    }
    void TearDown() override {
        viewer.reset();
        screen.reset();
        context.reset();
    }
    void frame(double seconds = 1.0 / 60) {
        viewer->update(seconds);
        viewer->draw(screen->framebuffer(), kFigureWidth, kFigureHeight);
    }
    template <class Done>
    void frames_until(Done&& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(10);
        do {
            frame(0);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (!done() && std::chrono::steady_clock::now() < end);
        ASSERT_TRUE(done());
        frame(0);
    }
    void open_both() {
        viewer->open({folder / "scene.glb", folder / "ball.glb"});
        frames_until([&] { return !viewer->jobs().busy(); });
        ASSERT_TRUE(viewer->messages().empty()) << viewer->messages().back();
    }
    const Moving& moving() const { return viewer->document().moving; }
    /// The middle of the figure in the scene.
    glm::vec3 middle() const { return glm::vec3(moving().pose().node(0) * glm::dvec4(0, kBallRadius, 0, 1)); }
    /// Moves the camera so close that the ball fills the picture.
    void look_at_ball(const glm::vec3& from) {
        viewer->camera = OrbitCamera(
            {.position = middle() + 1.4f * kBallRadius * glm::normalize(from), .target = middle()});
    }
    glm::dvec3 mean_of_left() {
        glm::dvec3 sum(0);
        const prt::Image image = viewer->renderer().read(0);
        for (const glm::vec3& pixel : image.pixels)
            sum += glm::dvec3(pixel);
        return sum / static_cast<double>(image.pixels.size());
    }

    prt::test::TemporaryFolder folder;
    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<Viewer> viewer;
    std::unique_ptr<Offscreen> screen;

private:
    static inline std::vector<std::byte> shipped_;
};

TEST_F(FigureTest, AnimatedFilesAreFiguresOnlyInAdditionToAScene) {
    viewer->open({folder / "ball.glb"});
    frames_until([&] { return viewer->document().model() != nullptr; });
    EXPECT_EQ(viewer->document().name(), "ball.glb");
    EXPECT_FALSE(moving().figure());
    viewer->open({folder / "scene.glb", folder / "ball.glb"});
    frames_until([&] { return viewer->document().name() == "scene.glb" && moving().figure(); });
    EXPECT_EQ(moving().path().filename(), "ball.glb");
}

TEST_F(FigureTest, WalksOnTheFloorAtItsSpeedAndStopsAtWalls) {
    open_both();
    const float floor = static_cast<float>(-viewer->document().model()->scene.origin.y);
    float way = 0;
    glm::vec3 last = middle();
    for (int i = 0; i < 600; ++i) {
        viewer->update(1.0 / 30);
        const glm::vec3 now = middle();
        EXPECT_NEAR(now.y, floor + kBallRadius, 1e-4f);
        way += glm::distance(now, last);
        last = now;
        const prt::Bounds& box = viewer->document().model()->box;
        EXPECT_GT(now.x, box.low.x);
        EXPECT_TRUE(now.x < box.high.x && now.z > box.low.z && now.z < box.high.z);
    }
    EXPECT_GT(way, 10); // 30 m, minus rotations
    EXPECT_LT(way, 1.01f * 1.5f * 20);
    viewer->settings.drawing.moving.walks = false;
    viewer->update(1);
    EXPECT_EQ(middle(), last);
}

TEST_F(FigureTest, FollowsThePathOfAScriptAtItsSpeed) {
    open_both();
    viewer->settings.drawing.moving.walks = false;
    viewer->choose_figure({.animation = "walk", .path = {{-1, 0, -1}, {2, 0, -1}, {2, 0, 1}}});
    const glm::dvec3 origin = viewer->document().model()->scene.origin;
    const auto expect_at = [&](const glm::dvec3& point) {
        EXPECT_LT(glm::distance(glm::dvec3(middle()) + origin, point + glm::dvec3(0, kBallRadius, 0)), 1e-4);
    };
    expect_at({-1, 0, -1});
    viewer->walk_figure(1); // 1.5 m
    expect_at({0.5, 0, -1});
    viewer->settings.drawing.moving.speed = 2;
    viewer->walk_figure(1); // and 3 m more, round the corner
    expect_at({2, 0, 0.5});
    EXPECT_THROW(viewer->choose_figure({.animation = "dance"}), prt::Error);
}

// Mean radiance of a ball under a day with a separate sun, by the volume and by paths: within the 8 % that
// issue 21 allows for incident light. Its pixels also differ by noise of the paths.
TEST_F(FigureTest, IsLitLikePathTracing) {
    prt::test::glb_of(shipped_scene(6, 3000, 512)).write(folder / "scene.glb");
    open_both();
    ASSERT_TRUE(moving().volume().volume);
    viewer->settings.drawing.moving.walks = false;
    viewer->choose_figure({.path = {{-2, 0, 0.5}}}); // a metre from the wall
    viewer->settings.left = PictureKind::prt_compressed;
    viewer->settings.right = PictureKind::reference;
    viewer->settings.difference = true;
    for (const glm::vec3& from :
         {glm::vec3(0.4f, 0.3f, 1), glm::vec3(-1, 0.5f, -0.3f), glm::vec3(0, -0.2f, -1)}) {
        look_at_ball(from);
        frame(0);
        frames_until([&] { return viewer->figures().reference_passes >= 64; });
        const Difference difference = viewer->figures().difference;
        ASSERT_EQ(difference.pixels, kFigureWidth * kFigureHeight);
        const glm::dvec3 left = mean_of_left();
        EXPECT_NEAR((left.r + left.g + left.b) / 3 / difference.mean, 1, 0.08);
        EXPECT_LT(difference.relative_l2, 0.15);
    }
}

TEST_F(FigureTest, FollowsTheLightLikeTheScene) {
    open_both();
    viewer->settings.drawing.moving.walks = false;
    viewer->settings.left = PictureKind::prt_compressed;
    viewer->settings.split = 1;
    look_at_ball({0.4f, 0.3f, 1});
    frame(0);
    const glm::dvec3 morning = mean_of_left();
    viewer->lights.day = viewer->lights.environment_on = false; // there is no light
    frame(0);
    EXPECT_LT(mean_of_left().g, 1e-4 * morning.g);
    viewer->lights.lights.push_back(make_light(LightKind::hemisphere));
    frame(0);
    const double once = mean_of_left().g;
    EXPECT_GT(once, 0);
    viewer->lights.lights[0].strength *= 2;
    frame(0);
    EXPECT_NEAR(mean_of_left().g, 2 * once, 0.02 * once); // half floats, and the window of a new light
}

/// The ball with lobes of open vertices, times `share`.
GlbFile ball_with_lobes(std::uint8_t share) {
    const std::string bare = ball_figure().bytes();
    prt::GltfDocument document = prt::parse_gltf(std::as_bytes(std::span(bare)), "ball.glb");
    prt::Scene scene = prt::extract_scene(document);
    for (prt::VertexArray& vertices : scene.vertex_arrays)
        vertices.lobes = true;
    prt::StoredLobes lobes;
    lobes.model.order = 4;
    lobes.model.lobes = 1;
    lobes.model.profiles = {{1, 2.0f / 3, 0.25f, 0}};
    for (const prt::VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& normal : vertices.normals) {
            const auto axis = prt::coded_axis(normal);
            lobes.model.words.push_back({axis[0], axis[1], 0, share});
        }
    prt::write_lobes(document, scene, lobes);
    return prt::test::glb_of(prt::encode_glb(document));
}

// Lobes along the normals are equal to the fragment shader without lobes, except for axes in bytes, 0.95
// degrees, and light interpolated between vertices, 7.5 degrees from each other.
TEST_F(FigureTest, IsLitByItsLobes) {
    std::array<glm::dvec3, 3> means;
    for (std::size_t i = 0; i < means.size(); ++i) {
        if (i > 0)
            ball_with_lobes(i == 1 ? 255 : 102).write(folder / "ball.glb");
        open_both();
        EXPECT_EQ(moving().lobes() != nullptr, i > 0);
        viewer->settings.drawing.moving.walks = false;
        viewer->settings.left = PictureKind::prt_compressed;
        viewer->settings.split = 1;
        viewer->lights.day = viewer->lights.environment_on = false;
        viewer->lights.lights = {make_light(LightKind::hemisphere)};
        look_at_ball({0.4f, 0.3f, 1});
        frame(0);
        means[i] = mean_of_left();
    }
    EXPECT_NEAR(means[1].g / means[0].g, 1, 0.02);
    EXPECT_NEAR(means[2].g / means[1].g, 102.0 / 255, 0.005);
}

// Only the figure blocks the only sun: its shadow is black.
TEST_F(FigureTest, CastsItsShadowIntoTheMapsOfTheSuns) {
    open_both();
    viewer->settings.drawing.moving.walks = false;
    viewer->choose_figure({.path = {{0, 0, 0}}});
    viewer->lights.day = viewer->lights.environment_on = false;
    viewer->lights.lights.push_back(make_light(LightKind::sun));
    viewer->lights.lights[0].direction = glm::normalize(glm::vec3(1, 1, 0));
    viewer->settings.left = PictureKind::unshadowed;
    viewer->settings.split = 1;
    const glm::vec3 behind =
        middle() - glm::vec3(0.55f, kBallRadius, 0); // the shadow's middle is 0.4 m aside
    viewer->camera = OrbitCamera({.position = behind + glm::vec3(-0.05f, 0.15f, 0.02f), .target = behind});
    viewer->settings.drawing.moving.figure = false;
    frame(0);
    const double open = mean_of_left().g;
    viewer->settings.drawing.moving.figure = true;
    frame(0);
    const double shadowed = mean_of_left().g;
    EXPECT_GT(open, 0.1);
    EXPECT_LT(shadowed, 0.05 * open);
    viewer->walk_figure(0); // and where it is gone again, all is as before
    viewer->settings.drawing.moving.figure = false;
    frame(0);
    EXPECT_NEAR(mean_of_left().g, open, 1e-6 * open);
}

// Under a uniform sky the floor loses the form factor of the ball on it, all of which is above the horizon.
TEST_F(FigureTest, DarkensTheFloorNearIt) {
    open_both();
    viewer->settings.drawing.moving.walks = false;
    viewer->choose_figure({.path = {{1, 0, 0}}}); // far from the wall
    viewer->lights.day = viewer->lights.environment_on = false;
    viewer->lights.lights.push_back(make_light(LightKind::hemisphere));
    viewer->settings.left = PictureKind::prt_compressed;
    viewer->settings.split = 1;
    constexpr float kAside = 0.6f;
    const glm::vec3 spot = middle() + glm::vec3(kAside, -kBallRadius, 0);
    viewer->camera = OrbitCamera({.position = spot + glm::vec3(0.05f, 0.15f, 0.02f), .target = spot});
    viewer->settings.drawing.moving.contact = false;
    frame(0);
    const double without = mean_of_left().g;
    viewer->settings.drawing.moving.contact = true;
    frame(0);
    const double left = mean_of_left().g / without;
    const double distance = std::hypot(kAside, kBallRadius),
                 ratio = static_cast<double>(kBallRadius) / distance;
    // Texels have a spacing of 0.25 m, and the light of the hemisphere has three bands.
    EXPECT_NEAR(left, 1 - ratio * ratio * static_cast<double>(kBallRadius) / distance, 0.06);
}

TEST_F(FigureTest, SpheresAndProbesAreShownAndALostContextBringsAllBack) {
    open_both();
    viewer->settings.left = PictureKind::prt_compressed;
    viewer->settings.split = 1;
    viewer->settings.drawing.moving.walks = false;
    const auto picture = [&] {
        frame(0);
        return viewer->renderer().read(0).pixels;
    };
    const auto bare = picture();
    viewer->settings.drawing.moving.spheres = true;
    const auto spheres = picture();
    viewer->settings.drawing.moving.probes = true;
    const auto probes = picture();
    EXPECT_NE(bare, spheres);
    EXPECT_NE(spheres, probes);
    viewer->release_gpu();
    screen.reset();
    context.reset();
    context = prt::GlContext::create(prt::GlDevice::any);
    screen = std::make_unique<Offscreen>(kFigureWidth, kFigureHeight);
    viewer->restore_gpu();
    EXPECT_EQ(picture(), probes);
}

TEST_F(FigureTest, ErrorsAreReportedAndTheSceneIsKept) {
    open_both();
    ball_figure(true).write(folder / "bad.glb");
    viewer->open({folder / "bad.glb"});
    frames_until([&] { return !viewer->jobs().busy(); });
    ASSERT_FALSE(viewer->messages().empty());
    EXPECT_NE(viewer->messages().back().find("time of keyframe 2 is not finite"), std::string::npos)
        << viewer->messages().back();
    EXPECT_EQ(viewer->document().name(), "scene.glb");
    EXPECT_EQ(moving().path().filename(), "ball.glb");
}

TEST(FigureScript, SetsPathsAndReportsErrors) {
    prt::test::TemporaryFolder folder;
    prt::test::glb_of(shipped_scene(3, 800, 64)).write(folder / "scene.glb");
    ball_figure().write(folder / "ball.glb");
    const auto said = [&](const char* step) {
        const auto script =
            folder.file("script.json", std::string(R"([{"size": [64, 36]}, {"open": "scene.glb"},
            {"wait": "work"}, )") + step + R"(, {"screenshot": "out.png"}])");
        try {
            run_script(script, {});
            return std::string();
        } catch (const prt::Error& error) {
            return std::string(error.what());
        }
    };
    EXPECT_EQ(
        said(
            R"({"figure": {"file": "ball.glb", "path": [[0, 0, 0], [1, 0, 0]], "scale": 0.5, "seconds": 2}})"),
        "");
    EXPECT_TRUE(std::filesystem::exists(folder / "out.png"));
    EXPECT_NE(said(R"({"figure": {"animation": "walk"}})").find("no figure is open"), std::string::npos);
    EXPECT_NE(said(R"({"figure": {"file": "ball.glb", "animation": "dance"}})").find("no animation 'dance'"),
              std::string::npos);
    EXPECT_NE(said(R"({"figure": {"file": "ball.glb", "scale": 0}})").find("scale of a figure"),
              std::string::npos);
}

TEST(JoinedScenes, KeepTheirMaterialsImagesAndReceivers) {
    prt::Scene first = prt::test::painted(SceneBuilder().floor({0, 0, 0}, 1).build(), glm::vec3(0.5f)),
               second =
                   prt::test::painted(SceneBuilder().sphere({0, 1, 0}, 0.5f, 4).build(), glm::vec3(0.25f));
    first.images.resize(2);
    second.images.resize(1);
    second.materials[0].base_color_texture.image = 0;
    const prt::Scene both = joined(first, second);
    EXPECT_EQ(both.triangles(), first.triangles() + second.triangles());
    EXPECT_EQ(both.vertex_arrays[1].first_receiver, first.receivers());
    const prt::Material& material = both.materials[both.primitives[1].material];
    EXPECT_EQ(material.base_color, glm::vec4(glm::vec3(0.25f), 1));
    EXPECT_EQ(material.base_color_texture.image, 2);
}

TEST(Grounds, EndAtWallsEdgesAndHighSteps) {
    // A step of 0.2 m at x = 1, one of 1 m at x = 2, an edge at z = 3, a wall at x = -3.
    const auto model = make_model(SceneBuilder()
                                      .floor({0, 0, 0}, 3, 2)
                                      .quad({-3, 0, 3}, {-3, 0, -3}, {-3, 2, -3}, {-3, 2, 3})
                                      .quad({1, 0.2f, 3}, {2, 0.2f, 3}, {2, 0.2f, -3}, {1, 0.2f, -3})
                                      .quad({2, 1.2f, 3}, {3, 1.2f, 3}, {3, 1.2f, -3}, {2, 1.2f, -3})
                                      .build(),
                                  "steps.glb");
    const Ground ground(*model, {.height = 1.8f, .width = 0.6f, .step = 0.35f});
    const auto floor = ground.below({0, 1.5f, 0});
    ASSERT_TRUE(floor);
    EXPECT_NEAR(floor->y, 0, 1e-6f);
    EXPECT_FALSE(ground.below({0, 1.5f, 4})); // beyond the edge
    EXPECT_NEAR(ground.free_way(*floor, {-1, 0, 0}, 5), 3, 1e-5f);
    const float to_step = ground.free_way(*floor, {1, 0, 0}, 5),
                to_edge = ground.free_way(*floor, {0, 0, 1}, 5);
    EXPECT_TRUE(to_step > 1.3f && to_step <= 2) << to_step; // up the low step, not the high one
    EXPECT_TRUE(to_edge > 2.3f && to_edge <= 3) << to_edge;
}

} // namespace
} // namespace viewer
