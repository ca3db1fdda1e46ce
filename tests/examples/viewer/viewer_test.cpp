// The viewer without a window: files of all kinds, work in the background, a context that is lost.

#include "core/viewer.h"
#include "gpu/lobe.h"
#include "gpu/offscreen.h"
#include "ui/controls.h"

#include "bake/gltf/reorder.h"
#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/gl/gl_context.h"
#include "prt/image/image_file.h"
#include "runtime/load/mesh_edges.h"
#include "support/glb_file.h"
#include "support/made_once.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

namespace viewer {
namespace {

using prt::test::made_once;
using prt::test::SceneBuilder;

constexpr int kWidth = 160, kHeight = 90;

class ViewerTest : public testing::Test {
protected:
    void SetUp() override {
        context = prt::GlContext::create(prt::GlDevice::any);
        ASSERT_TRUE(context);
        viewer = std::make_unique<Viewer>();
        screen = std::make_unique<Offscreen>(kWidth, kHeight);
        viewer->settings.panels = false;
    }
    void TearDown() override {
        viewer.reset();
        screen.reset();
        context.reset();
    }

    std::filesystem::path unbaked() const {
        std::filesystem::path path = folder / "ball.glb";
        prt::test::scene_file(
            SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 10).sphere({0, 0, 0}, 0.5f, 12).build())
            .write(path);
        return path;
    }
    std::filesystem::path baked(int order = 4) const {
        return made_once("baked" + std::to_string(order), folder / "baked.glb", [&](const auto& path) {
            prt::GltfDocument document = prt::load_gltf(unbaked());
            const prt::Scene scene = prt::extract_scene(document);
            prt::BakeOptions options;
            options.order = order;
            options.rays = 64;
            options.tracer.backend = prt::Backend::cpu;
            prt::write_transfer(document, scene, prt::bake(scene, options).baked);
            prt::save_glb(document, path);
        });
    }
    std::filesystem::path shipped(bool reordered = false) const {
        return made_once(reordered ? "reordered" : "shipped", folder / "shipped.glb",
                         [&](const auto& path) { write_shipped(path, reordered); });
    }
    void write_shipped(const std::filesystem::path& path, bool reordered) const {
        prt::GltfDocument document = prt::load_gltf(baked());
        const prt::Scene scene = prt::extract_scene(document);
        const auto transfer = prt::read_transfer(document, scene);
        const prt::CompressOptions options{.clusters = 16, .coding = prt::preset_u32()};
        prt::CompressedTransfer compressed{
            prt::compress(transfer->transfer, {prt::receiver_areas(scene), prt::mesh_edges(scene)}, options)
                .transfer,
            transfer->record};
        if (reordered) {
            const auto order = prt::order_by_cluster(scene, compressed.transfer.receivers);
            prt::reorder_vertices(document, scene, order);
            compressed.transfer.receivers = prt::reordered(compressed.transfer.receivers, order);
        }
        prt::write_clustered(document, scene, compressed);
        prt::save_glb(document, path);
    }

    void frame() {
        viewer->update(1.0 / 60);
        viewer->draw(screen->framebuffer(), kWidth, kHeight);
    }
    template <class Done>
    void frames_until(Done&& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        do {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (!done() && std::chrono::steady_clock::now() < end);
        ASSERT_TRUE(done());
        frame();
    }
    void open(const std::vector<std::filesystem::path>& paths) {
        viewer->open(paths);
        frames_until([&] { return !viewer->jobs().busy(); });
    }
    PictureKind right() { return viewer->shown(viewer->settings.right).kind; }

    prt::test::TemporaryFolder folder;
    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<Viewer> viewer;
    std::unique_ptr<Offscreen> screen;
};

TEST_F(ViewerTest, BakesAndShowsIntermediateResults) {
    viewer->settings.right = PictureKind::prt;
    viewer->open({unbaked()});
    bool early = false;
    frames_until([&] {
        early |= viewer->jobs().busy() && viewer->document().raw();
        return !viewer->jobs().busy();
    });
    EXPECT_TRUE(early);
    EXPECT_TRUE(viewer->messages().empty());
    for (const PictureName& name : kPictures) {
        viewer->settings.right = name.kind;
        frame();
        if (shows_numbers(name.kind))
            frames_until([&] { return right() == name.kind; });
        EXPECT_EQ(right(), name.kind) << name.id;
    }
    EXPECT_GT(viewer->figures().transfer.bytes_per_receiver, 0);
    EXPECT_EQ(viewer->figures().transfer.order, 6);
}

TEST_F(ViewerTest, OpensCompressedFilesAndReportsMissingPictures) {
    viewer->settings.right = PictureKind::prt;
    open({shipped()});
    EXPECT_EQ(viewer->figures().transfer.order, 4);
    EXPECT_EQ(viewer->figures().transfer.bytes_per_receiver, 4);
    EXPECT_EQ(right(), PictureKind::unshadowed);
    EXPECT_NE(viewer->shown(PictureKind::prt).note.find("bake again to see it"), std::string::npos);
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).kind, PictureKind::prt_compressed);
    EXPECT_GT(viewer->figures().milliseconds.open, 0);
    viewer->bake_anew();
    frames_until([&] { return !viewer->jobs().busy(); });
    EXPECT_EQ(right(), PictureKind::prt);
}

TEST_F(ViewerTest, CombinesABakeAndItsCompressedFile) {
    for (const bool reordered : {false, true})
        for (const bool at_once : {false, true})
            for (const bool bake_first : {false, true}) {
                TearDown();
                SetUp();
                const std::filesystem::path b = baked(), s = shipped(reordered);
                if (at_once) {
                    open(bake_first ? std::vector{b, s} : std::vector{s, b});
                } else {
                    open({bake_first ? b : s});
                    open({bake_first ? s : b});
                }
                EXPECT_TRUE(viewer->messages().empty()) << viewer->messages().front();
                viewer->settings.left = PictureKind::prt;
                viewer->settings.right = PictureKind::prt_compressed;
                viewer->settings.difference = true;
                frame();
                EXPECT_EQ(right(), PictureKind::prt_compressed);
                EXPECT_EQ(viewer->shown(PictureKind::prt).kind, PictureKind::prt);
                // Compressed well, and each vertex with its own transfer.
                EXPECT_LT(viewer->figures().difference.relative_l2, 0.03);
                EXPECT_GT(viewer->figures().difference.relative_l2, 0);
            }
}

TEST_F(ViewerTest, RejectsADifferentSceneForABake) {
    const std::filesystem::path other = folder / "other.glb";
    prt::test::scene_file(SceneBuilder().floor({0, 0, 0}, 1).build()).write(other);
    open({shipped(), other});
    ASSERT_FALSE(viewer->messages().empty());
    EXPECT_NE(viewer->messages().back().find("other.glb: contains a different scene"), std::string::npos);
}

TEST_F(ViewerTest, SurvivesDamagedFiles) {
    const auto write = [&](const char* name, const std::string& text) { return folder.file(name, text); };
    std::string glb = prt::test::scene_file(SceneBuilder().floor({0, 0, 0}, 1).build()).bytes();
    const std::pair<std::filesystem::path, const char*> files[] = {
        {folder / "missing.glb", "missing.glb"},
        {write("empty.glb", ""), "empty.glb"},
        {write("noise.glb", "glTFnothing of the kind"), "noise.glb"},
        {write("cut.glb", glb.substr(0, glb.size() / 2)), "cut.glb"},
        {write("notes.txt", "hello"), "is neither a model"},
        {write("noise.hdr", "no picture"), "noise.hdr"},
        {folder / "missing.exr", "missing.exr"},
    };
    for (const auto& [path, part] : files) {
        viewer->dismiss_messages();
        viewer->open({path});
        frames_until([&] { return !viewer->messages().empty(); });
        EXPECT_NE(viewer->messages().back().find(part), std::string::npos) << viewer->messages().back();
    }
    // A picture that is no environment.
    prt::write_exr(folder / "photograph.exr", {30, 20, std::vector<glm::vec3>(600, glm::vec3(1))});
    viewer->dismiss_messages();
    viewer->open({folder / "photograph.exr"});
    frames_until([&] { return !viewer->messages().empty(); });
    // And it still works.
    viewer->dismiss_messages();
    open({shipped()});
    EXPECT_TRUE(viewer->messages().empty());
    EXPECT_EQ(right(), PictureKind::prt_compressed);
}

TEST_F(ViewerTest, SeparatesSunsByDefault) {
    open({shipped()});
    viewer->settings.split = 0;
    const auto picture = [&] {
        frame();
        return viewer->renderer().read(1);
    };
    const prt::Image separate = picture();
    const float stops = viewer->lighting().meter.stops();
    viewer->settings.lit.separate_suns = false;
    const prt::Image together = picture();
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < separate.pixels.size(); ++i) {
        difference += static_cast<double>(glm::distance(separate.pixels[i], together.pixels[i]));
        sum += static_cast<double>(glm::length(together.pixels[i]));
    }
    EXPECT_GT(difference, 0.02 * sum);
    EXPECT_EQ(viewer->lighting().meter.stops(), stops); // unchanged, so that both can be compared
    viewer->settings.lit.separate_suns = true;
    EXPECT_EQ(picture().pixels, separate.pixels);
    viewer->lights.time.hour = 0; // no sun, no difference
    const prt::Image night = picture();
    viewer->settings.lit.separate_suns = false;
    EXPECT_EQ(picture().pixels, night.pixels);
}

TEST_F(ViewerTest, ReportsTransferWithoutDirectTerm) {
    prt::GltfDocument document = prt::load_gltf(unbaked());
    const prt::Scene scene = prt::extract_scene(document);
    prt::BakeOptions options;
    options.rays = 64;
    prt::BakedTransfer bake = prt::bake(scene, options).baked;
    bake.transfer = prt::as_combined(bake.transfer);
    prt::write_transfer(document, scene, bake);
    prt::save_glb(document, folder / "whole.glb");
    open({folder / "whole.glb"});
    EXPECT_EQ(viewer->shown(PictureKind::prt).kind, PictureKind::prt);
    EXPECT_NE(viewer->shown(PictureKind::prt).note.find("the transfer has no direct term"),
              std::string::npos);
    EXPECT_TRUE(viewer->shown(PictureKind::unshadowed).note.empty());
    viewer->settings.lit.separate_suns = false;
    frame();
    EXPECT_TRUE(viewer->shown(PictureKind::prt).note.empty());
}

TEST_F(ViewerTest, OpensEnvironments) {
    open({shipped()});
    EXPECT_TRUE(viewer->lights.day);
    prt::write_exr(folder / "red.exr", {32, 16, std::vector<glm::vec3>(512, glm::vec3(1, 0, 0))},
                   prt::EnvironmentLayout::lat_long);
    viewer->open({folder / "red.exr"});
    frames_until([&] { return !viewer->lighting().environments.empty(); });
    EXPECT_FALSE(viewer->lights.day);
    viewer->settings.split = 0;
    viewer->settings.drawing.textured = false;
    frame();
    const prt::Image image = viewer->renderer().read(1);
    for (const glm::vec3& pixel : image.pixels)
        EXPECT_EQ(pixel.g, 0);
    EXPECT_NEAR(image.at(kWidth / 2, kHeight - 4).r, 1, 0.3f);
}

TEST_F(ViewerTest, ListsEveryEnvironment) {
    std::vector<std::filesystem::path> paths;
    for (const char* name : {"a.exr", "b.exr", "c.exr"}) {
        paths.push_back(folder / name);
        prt::write_exr(paths.back(), {4, 2, std::vector<glm::vec3>(8, glm::vec3(1))},
                       prt::EnvironmentLayout::lat_long);
    }
    paths.insert(paths.begin() + 1, folder / "missing.exr");
    viewer->open(paths);
    viewer->open({paths[0]}); // before the others are read
    frames_until([&] { return !viewer->jobs().busy(); });
    EXPECT_EQ(viewer->lighting().environments.size(), 4u);
    EXPECT_EQ(viewer->messages().size(), 1u);
    viewer->use_environment(0);
    frame();
}

TEST_F(ViewerTest, LimitsTheBasesOfSmallModels) {
    open({baked(6)});
    const auto receivers = static_cast<double>(viewer->figures().receivers);
    EXPECT_LT(receivers, 1000);
    EXPECT_EQ(viewer->figures().transfer.bytes_per_receiver, 4); // one word, as in the preset
    // Bases have twice the weights' bytes, or 4 KB; 256 clusters would need ten times that.
    EXPECT_LE(viewer->figures().transfer.bytes_with_bases, 4 + std::max(8.0, 4096 / receivers));
}

TEST_F(ViewerTest, SavesTheCompressedModelInItsFolder) {
    open({baked()});
    viewer->compression = {3, 8, 2};
    frame();
    frames_until([&] { return !viewer->jobs().busy(); });
    for (const char* name : {"baked.shipped.glb", "baked.shipped-2.glb"}) { // no file is overwritten
        viewer->save();
        frames_until([&] { return !viewer->jobs().busy(); });
        ASSERT_FALSE(viewer->messages().empty());
        EXPECT_NE(viewer->messages().back().find(name), std::string::npos) << viewer->messages().back();
        const prt::GltfDocument document = prt::load_gltf(folder / name);
        const auto saved = prt::read_clustered(document, prt::extract_scene(document));
        ASSERT_TRUE(saved);
        EXPECT_EQ(saved->transfer.bases.layout.order, 3);
        EXPECT_EQ(static_cast<int>(saved->transfer.bases.clusters()), viewer->figures().transfer.clusters);
        EXPECT_EQ(saved->record.rays, 64); // from the bake
        EXPECT_FALSE(prt::read_transfer(document, prt::extract_scene(document)));
    }
    viewer->save(folder / "missing" / "a.glb");
    frames_until([&] { return !viewer->jobs().busy(); });
    EXPECT_NE(viewer->messages().back().find("a.glb"), std::string::npos) << viewer->messages().back();
}

TEST_F(ViewerTest, ResetsTheCamera) {
    open({shipped()});
    const prt::Camera before = viewer->camera.camera();
    viewer->camera.orbit({0.3f, 0.2f});
    viewer->camera.pan({0.1f, 0.1f});
    viewer->camera.zoom(3);
    Controls(*viewer).key('R');
    EXPECT_EQ(viewer->camera.camera().position, before.position);
    EXPECT_EQ(viewer->camera.camera().target, before.target);
}

TEST_F(ViewerTest, MetersTheModelAndNotTheSky) {
    // An open floor of base color c under light of radiance 4 has radiance 4 c, which is mapped to 0.22.
    prt::test::GlbFile file = prt::test::scene_file(SceneBuilder().floor({0, 0, 0}, 1, 4).build());
    file.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.125, 1}}, {"metallicFactor", 0}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "floor.glb");
    prt::write_exr(folder / "four.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(4))});
    open({folder / "floor.glb", folder / "four.exr"});
    frames_until([&] { return !viewer->jobs().busy(); });
    const double luminance = 4 * (0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722 * 0.125);
    EXPECT_NEAR(viewer->lighting().meter.stops(), std::log2(0.22 / luminance), 0.01);
    viewer->settings.drawing.textured = false;
    frame();
    EXPECT_NEAR(viewer->lighting().meter.stops(), std::log2(0.22 / 4), 0.01);
    viewer->lights.day = false; // twice the light, half the exposure
    viewer->lights.lights = {make_light(LightKind::cone)};
    viewer->lights.lights[0].color = glm::vec3(1);
    viewer->lights.lights[0].direction = {0, 1, 0};
    viewer->lights.lights[0].size = std::numbers::pi_v<float> / 2; // all of the sky, once more
    viewer->lights.lights[0].strength = 1;
    frame();
    EXPECT_NEAR(viewer->lighting().meter.stops(), std::log2(0.22 / 8), 0.03);
}

TEST_F(ViewerTest, RecompressesAfterSliderChanges) {
    open({baked()});
    const double before = viewer->figures().transfer.bytes_with_bases;
    viewer->compression = {3, 8, 2};
    frame();
    EXPECT_TRUE(viewer->jobs().busy());
    frames_until([&] { return !viewer->jobs().busy(); });
    EXPECT_EQ(viewer->figures().transfer.order, 3);
    EXPECT_LE(viewer->figures().transfer.clusters, 8);
    EXPECT_LT(viewer->figures().transfer.bytes_with_bases, before);
    EXPECT_EQ(right(), PictureKind::prt_compressed);
    // Order beyond the bake's is brought back to it.
    viewer->compression.order = 9;
    frame();
    EXPECT_EQ(viewer->compression.order, 4);
}

TEST_F(ViewerTest, RecoversFromAContextLoss) {
    open({baked(), shipped()});
    viewer->settings.split = 0;
    frame();
    const prt::Image before = viewer->renderer().read(1);
    viewer->release_gpu();
    screen.reset();
    context.reset();
    context = prt::GlContext::create(prt::GlDevice::any);
    screen = std::make_unique<Offscreen>(kWidth, kHeight);
    viewer->restore_gpu();
    frame();
    EXPECT_EQ(viewer->renderer().read(1).pixels, before.pixels);
}

TEST_F(ViewerTest, RefinesTheReference) {
    open({baked(), shipped()}); // compressed already
    viewer->settings.right = PictureKind::reference;
    viewer->settings.left = PictureKind::prt;
    viewer->settings.difference = true;
    viewer->lights.day = viewer->lights.environment_on = false;
    viewer->lights.lights = {make_light(LightKind::hemisphere)};
    frames_until([&] { return viewer->figures().reference_passes >= 4; });
    const double early = viewer->figures().difference.relative_l2;
    frames_until([&] { return viewer->figures().reference_passes >= 64; });
    const double late = viewer->figures().difference.relative_l2;
    EXPECT_LT(late, early);
    EXPECT_LT(late, 0.08); // 64 rays in the bake, 64 paths here, a coarse mesh
    // A different light restarts it.
    viewer->lights.rotation = 1;
    frame();
    EXPECT_LT(viewer->figures().reference_passes, 64);
}

TEST_F(ViewerTest, ShowsTheReceiverUnderThePointer) {
    open({baked(), shipped()});
    viewer->settings.lobe = true;
    const Model& model = *viewer->document().model();
    const glm::vec3 point = model.scene.vertex_arrays[0].positions[60];
    viewer->camera =
        OrbitCamera({point + 2.0f * model.scene.vertex_arrays[0].normals[60] + glm::vec3(0.01f, 0, 0.3f),
                     point,
                     {0, 1, 0},
                     0.6f});
    viewer->hover(glm::vec2(kWidth / 2, kHeight / 2));
    frame();
    ASSERT_TRUE(viewer->hovered());
    EXPECT_EQ(viewer->hovered()->position, point);
    EXPECT_GE(viewer->hovered()->cluster, 0);
    EXPECT_EQ(viewer->hovered()->vector.size(), 16u);
    for (const float weight : viewer->hovered()->weights) {
        EXPECT_GE(weight, -1);
        EXPECT_LE(weight, 1);
    }
    viewer->hover(glm::vec2(1, 1)); // the sky
    viewer->camera = OrbitCamera({{0, 1, 9}, {0, 9, 0}, {0, 1, 0}, 0.3f});
    frame();
    EXPECT_FALSE(viewer->hovered());
}

TEST_F(ViewerTest, LightsCanBeDragged) {
    open({shipped()});
    Controls controls(*viewer);
    viewer->lights.lights = {make_light(LightKind::sun)};
    frame();
    const auto at = pixel_of(viewer->screen(), handle_position(*viewer, viewer->lights.lights[0]));
    ASSERT_TRUE(at);
    EXPECT_EQ(controls.light_at(*at), 0);
    controls.press(Button::left, *at);
    controls.move(*at + glm::vec2(-12, 5));
    const auto moved = pixel_of(viewer->screen(), handle_position(*viewer, viewer->lights.lights[0]));
    EXPECT_LT(glm::distance(*moved, *at + glm::vec2(-12, 5)), 2);
    controls.release();
    controls.move({0, 0});
    // The split, the environment, the camera.
    controls.press(Button::left, {kWidth / 2, 80});
    controls.move({kWidth / 4, 80});
    EXPECT_NEAR(viewer->settings.split, 0.25f, 1e-6f);
    controls.press(Button::right, {100, 50});
    controls.move({145, 50}); // half a height: a quarter rotation
    EXPECT_NEAR(viewer->lights.rotation, 1.5708f, 1e-3f);
    const glm::vec3 before = viewer->camera.camera().position;
    controls.press(Button::left, {10, 10});
    controls.move({40, 10});
    EXPECT_GT(glm::distance(before, viewer->camera.camera().position), 0.1f);
}

TEST_F(ViewerTest, SupportsAllWindowSizes) {
    open({shipped()});
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {7, 300}, {333, 2}, {640, 360}}) {
        const Offscreen other(size.x, size.y);
        viewer->update(0.1);
        EXPECT_NO_THROW(viewer->draw(other.framebuffer(), size.x, size.y));
    }
}

TEST(Lobe, HasTheRadiusOfTheFunction) {
    // Y_10 = 0.4886 z: two balls along z, red above.
    const std::vector<float> function = {0, 0, 1, 0};
    const ColoredMesh lobe = make_lobe(2, function, {1, 2, 3}, 0.5f, {0, 0, 1});
    float farthest = 0;
    for (std::size_t i = 0; i < lobe.positions.size(); ++i) {
        const glm::vec3 d = lobe.positions[i] - glm::vec3(1, 2, 3);
        const float length = glm::length(d);
        farthest = std::max(farthest, length);
        if (length > 0.01f) {
            EXPECT_NEAR(length, 0.5f * std::abs(d.z / length), 1e-4f);
            EXPECT_EQ(lobe.colors[i].r > lobe.colors[i].b, d.z > 0);
        }
    }
    EXPECT_NEAR(farthest, 0.5f, 0.002f);
}

} // namespace
} // namespace viewer
