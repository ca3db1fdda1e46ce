// Tests lightmaps in the viewer: alone, together with vertices, and with files that do not belong together.

#include "core/viewer.h"
#include "examples/viewer/lightmap_files.h"
#include "gpu/offscreen.h"
#include "script/script.h"
#include "ui/controls.h"

#include "prt/core/error.h"
#include "prt/gl/gl_context.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <thread>

namespace viewer {
namespace {

class LightmapViewer : public testing::Test {
protected:
    void SetUp() override {
        context = prt::GlContext::create(prt::GlDevice::any);
        ASSERT_TRUE(context);
        viewer = std::make_unique<Viewer>();
        screen = std::make_unique<Offscreen>(96, 64);
        viewer->settings.panels = false;
    }
    void TearDown() override {
        viewer.reset();
        screen.reset();
        context.reset();
    }

    void frame() {
        viewer->update(1.0 / 60);
        viewer->draw(screen->framebuffer(), 96, 64);
    }
    void work() {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        do {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while ((viewer->jobs().busy() || viewer->jobs().busy(JobKind::numbers)) &&
                 std::chrono::steady_clock::now() < end);
        frame();
    }
    void open(const std::vector<std::filesystem::path>& paths) {
        viewer->open(paths);
        work();
    }
    std::string message() const { return viewer->messages().empty() ? "" : viewer->messages().back(); }
    double difference(PictureKind left, PictureKind right) {
        viewer->settings.left = left;
        viewer->settings.right = right;
        viewer->settings.difference = true;
        frame();
        return viewer->figures().difference.relative_l2;
    }

    LightmapFiles files;
    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<Viewer> viewer;
    std::unique_ptr<Offscreen> screen;
};

TEST_F(LightmapViewer, CompressesABakeAndReportsItsSize) {
    open({files.raw()});
    EXPECT_EQ(message(), "");
    EXPECT_TRUE(viewer->document().loaded.of_texels());
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed})
        EXPECT_EQ(viewer->shown(kind).kind, kind);
    EXPECT_LT(difference(PictureKind::prt, PictureKind::prt_compressed), 0.2);
    EXPECT_GT(viewer->figures().difference.relative_l2, 0);
    ASSERT_TRUE(viewer->figures().lightmap);
    const LightmapFigures& figures = *viewer->figures().lightmap;
    ASSERT_EQ(figures.maps.size(), 1u);
    EXPECT_EQ(figures.maps[0].width, 64);
    EXPECT_EQ(figures.texels, 64u * 64);
    EXPECT_GT(figures.receivers, 0u);
    EXPECT_LT(figures.receivers, figures.texels);
    EXPECT_EQ(figures.transfer.bytes_per_receiver, 4); // one word, as in the preset
    EXPECT_EQ(figures.transfer.order, 4);
    EXPECT_EQ(viewer->figures().transfer.bytes_per_receiver, 0); // there is no transfer of vertices
    // Sliders compress anew.
    viewer->compression = {.order = 3, .clusters = 4, .components = 1};
    work();
    EXPECT_EQ(viewer->figures().lightmap->transfer.order, 3);
    EXPECT_LE(viewer->figures().lightmap->transfer.clusters, 4);
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).kind, PictureKind::prt_compressed);
}

TEST_F(LightmapViewer, SavesTheCompressedLightmap) {
    open({files.raw()});
    const std::filesystem::path output = files.folder() / "kept.glb";
    viewer->save(output);
    work();
    EXPECT_NE(message().find("saved "), std::string::npos);
    viewer->dismiss_messages();
    open({output});
    EXPECT_EQ(message(), "");
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).kind, PictureKind::prt_compressed);
    // The bake that was open is of it.
    EXPECT_EQ(viewer->shown(PictureKind::prt).kind, PictureKind::prt);
    const double again = difference(PictureKind::prt, PictureKind::prt_compressed);
    EXPECT_GT(again, 0);
    EXPECT_LT(again, 0.2);
}

TEST_F(LightmapViewer, CombinesABakeAndItsCompressedFile) {
    for (const bool bake_first : {false, true})
        for (const bool at_once : {false, true}) {
            TearDown();
            SetUp();
            const std::filesystem::path shipped = files.shipped(), raw = files.raw();
            const std::filesystem::path first = bake_first ? raw : shipped,
                                        second = bake_first ? shipped : raw;
            if (at_once) {
                open({first, second});
            } else {
                open({first});
                open({second});
            }
            EXPECT_EQ(message(), "");
            EXPECT_FALSE(viewer->document().has_both());
            EXPECT_EQ(viewer->shown(PictureKind::prt).kind, PictureKind::prt);
            EXPECT_EQ(viewer->figures().lightmap->transfer.bytes_per_receiver, 8); // from the file
            EXPECT_LT(difference(PictureKind::prt, PictureKind::prt_compressed), 0.1);
        }
}

TEST_F(LightmapViewer, ReportsPicturesThatNeedMoreThanALightmap) {
    open({files.shipped()});
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).kind, PictureKind::prt_compressed);
    EXPECT_EQ(viewer->shown(PictureKind::clusters).note, "not available yet");
    EXPECT_EQ(viewer->never_shown(PictureKind::clusters), "");
    for (const PictureKind kind : {PictureKind::prt, PictureKind::error, PictureKind::seams})
        EXPECT_NE(viewer->never_shown(kind).find("also open its bake"), std::string::npos)
            << name_of(kind).id;
    EXPECT_NE(viewer->never_shown(PictureKind::surface_error).find("only vertices"), std::string::npos);
    EXPECT_EQ(viewer->never_shown(PictureKind::reference), "");
    EXPECT_FALSE(viewer->can_measure());
    EXPECT_FALSE(viewer->can_bake());
    viewer->measure_budget();
    EXPECT_NE(message().find("only vertices"), std::string::npos);
}

TEST_F(LightmapViewer, ShowsVerticesAndALightmapSideBySide) {
    for (const bool lightmap_first : {false, true})
        for (const bool at_once : {false, true}) {
            TearDown();
            SetUp();
            const std::filesystem::path vertices = files.vertices(), lightmap = files.shipped();
            const std::filesystem::path first = lightmap_first ? lightmap : vertices,
                                        second = lightmap_first ? vertices : lightmap;
            if (at_once) {
                open({first, second});
            } else {
                open({first});
                open({second});
            }
            EXPECT_EQ(message(), "");
            ASSERT_TRUE(viewer->document().has_both());
            EXPECT_FALSE(viewer->document().loaded.of_texels());
            EXPECT_TRUE(viewer->document().beside.of_texels());
            // Vertices on the left, the lightmap on the right: the light is equal, measured at different
            // positions.
            const double beside = difference(PictureKind::prt_compressed, PictureKind::prt_compressed);
            EXPECT_GT(beside, 0.01);
            EXPECT_LT(beside, 0.4);
            viewer->settings.drawing.lightmap.left = true;
            EXPECT_EQ(difference(PictureKind::prt_compressed, PictureKind::prt_compressed), 0);
            // Vertices have a bake; the lightmap has none.
            EXPECT_EQ(viewer->never_shown(PictureKind::prt), "");
            EXPECT_NE(viewer->never_shown({PictureKind::prt, Receivers::texels}), "");
            EXPECT_TRUE(viewer->can_measure());
        }
}

TEST_F(LightmapViewer, CompletesAVertexBakeWhileALightmapIsOpened) {
    const std::filesystem::path lightmap = files.shipped();
    viewer->open({files.unbaked()});
    while (!viewer->document().raw() && viewer->jobs().busy())
        frame();
    if (!viewer->jobs().busy())
        GTEST_SKIP() << "the bake was done between two frames";
    open({lightmap});
    EXPECT_EQ(message(), "");
    EXPECT_TRUE(viewer->document().has_both());
    ASSERT_TRUE(viewer->document().raw());
    EXPECT_EQ(viewer->document().loaded.record.rays, 1024);
}

TEST_F(LightmapViewer, HasNumbersOfBoth) {
    open({files.vertices(), files.raw()});
    ASSERT_TRUE(viewer->document().has_both());
    viewer->settings.left = viewer->settings.right = PictureKind::error;
    work();
    EXPECT_EQ(viewer->shown(left_picture(viewer->settings)).kind, PictureKind::error);
    EXPECT_EQ(viewer->shown(right_picture(viewer->settings)).kind, PictureKind::error);
    EXPECT_EQ(message(), "");
    viewer->release_gpu(); // simulates a driver reset
    viewer->restore_gpu();
    work();
    EXPECT_EQ(viewer->shown(left_picture(viewer->settings)).kind, PictureKind::error);
    EXPECT_EQ(viewer->shown(right_picture(viewer->settings)).kind, PictureKind::error);
}

TEST_F(LightmapViewer, RejectsMismatchedFiles) {
    const std::filesystem::path shipped = files.shipped(), other = files.folder() / "other.glb";
    std::filesystem::copy_file(files.raw(32), files.folder() / "coarse.glb");
    prt::test::scene_file(prt::test::SceneBuilder().floor({0, 0, 0}, 1).build()).write(other);
    open({shipped, other});
    EXPECT_NE(message().find("other.glb: contains a different scene than "), std::string::npos) << message();
    viewer->dismiss_messages();
    open({shipped, shipped});
    EXPECT_NE(message().find("lightmap.shipped.glb: contains no additional transfer for "), std::string::npos)
        << message();
    viewer->dismiss_messages();
    open({shipped, files.folder() / "coarse.glb"});
    EXPECT_NE(message().find("coarse.glb: its maps differ from those of "), std::string::npos) << message();
    viewer->dismiss_messages();
    // A damaged image names the file.
    prt::test::GlbFile damaged = prt::test::read_glb(shipped);
    for (const auto& image : damaged.json["images"]) {
        const auto& view = damaged.json["bufferViews"][image["bufferView"].get<std::size_t>()];
        damaged.binary[view["byteOffset"].get<std::size_t>() + 20] ^= std::byte{0xff}; // within IHDR
    }
    damaged.write(files.folder() / "damaged.glb");
    open({files.folder() / "damaged.glb"});
    EXPECT_NE(message().find("damaged.glb"), std::string::npos) << message();
    viewer->dismiss_messages();
    open({shipped}); // and it still works
    EXPECT_EQ(message(), "");
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).kind, PictureKind::prt_compressed);
}

TEST_F(LightmapViewer, SwapsSidesWithTheirReceivers) {
    Controls controls(*viewer);
    EXPECT_TRUE(controls.key('X'));
    EXPECT_EQ(viewer->settings.drawing.lightmap, (LightmapSides{.left = true, .right = false}));
}

TEST(LightmapScript, DrawsTheGridAndReports) {
    const LightmapFiles files;
    const std::filesystem::path script = files.folder().file("script.json", R"([
        {"size": [320, 180]}, {"wait": "work"},
        {"camera": {"position": [1, 0.5, 1.01], "target": [1, -0.5, 1]}},
        {"set": {"left": "prt_compressed", "right": "prt_compressed", "panels": false, "split": 0.5}},
        {"screenshot": "plain.png"}, {"figures": "figures.json"},
        {"set": {"texel_grid": true}}, {"screenshot": "grid.png"},
        {"keys": "M"}, {"screenshot": "again.png"},
        {"set": {"left_lightmap": true}}, {"screenshot": "both.png"},
        {"set": {"left_lightmap": false, "left": "unshadowed", "right": "unshadowed", "texel_grid": true, "difference": true}},
        {"figures": "same.json"}
    ])");
    run_script(script, {files.vertices(), files.shipped()});
    const auto picture = [&](const char* name) {
        return prt::decode_image(prt::read_file(files.folder() / name)).pixels;
    };
    const auto json = [&](const char* name) {
        const auto bytes = prt::read_file(files.folder() / name);
        return nlohmann::json::parse(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    };
    EXPECT_NE(picture("plain.png"), picture("grid.png"));
    EXPECT_EQ(picture("plain.png"), picture("again.png"));
    EXPECT_NE(picture("plain.png"), picture("both.png"));
    const nlohmann::json figures = json("figures.json");
    EXPECT_EQ(figures["lightmap"]["maps"], nlohmann::json::parse("[[64, 64]]"));
    EXPECT_EQ(figures["lightmap"]["bytes_per_texel"], 8);
    EXPECT_GT(figures["bytes_per_vertex"].get<double>(), 0);
    EXPECT_EQ(json("same.json")["difference_relative_l2"].get<double>(), 0);
}

} // namespace
} // namespace viewer
