// Tests lamps and emission: their strengths in every picture, in the panel's keys and in scripts.

#include "core/viewer.h"
#include "gpu/offscreen.h"
#include "script/script.h"
#include "ui/controls.h"

#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/gl/gl_renderer.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace viewer {
namespace {

using prt::test::SceneBuilder;

constexpr int kColumns = 128, kRows = 72;

float largest(const glm::vec3& v) {
    return std::max({v.r, v.g, v.b});
}

prt::TransferLayout layout_with(const std::vector<std::string>& names) {
    prt::TransferLayout layout{2, {{prt::TermKind::combined, 1}}};
    for (const std::string& name : names)
        layout.terms.push_back({prt::TermKind::lamp, 1, name});
    return layout;
}

TEST(LampStrengths, AreProductsOfOwnAndGlobalStrength) {
    LampSettings settings{
        .strength = 2,
        .each = {{.name = "b", .strength = 3, .color = {1, 0.5f, 0}}, {.name = "c", .on = false}}};
    const std::vector<glm::vec3> expected = {glm::vec3(2), {6, 3, 0}, glm::vec3(0)};
    EXPECT_EQ(strengths_of(settings, layout_with({"a", "b", "c"})), expected);
    EXPECT_TRUE(any_shines(settings));
    settings.on = false;
    EXPECT_EQ(strengths_of(settings, layout_with({"a", "b"})), std::vector<glm::vec3>(2, glm::vec3(0)));
    EXPECT_FALSE(any_shines(settings));
}

TEST(LampStrengths, AreKeptForTransferWithTheSameLamps) {
    const prt::TransferLayout raw = layout_with({"a", "b"}), compressed = layout_with({"b", "c"});
    const prt::TransferLayout* both[] = {&raw, &compressed};
    const std::vector<LampControl> lamps = lamps_of(both, {{.name = "b", .strength = 5}, {.name = "gone"}});
    const std::vector<LampControl> expected = {{.name = "a"}, {.name = "b", .strength = 5}, {.name = "c"}};
    EXPECT_EQ(lamps, expected);
}

/// A sphere on a floor under two lamps.
prt::Scene lit_scene() {
    prt::Scene scene =
        prt::test::painted(SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 16).sphere({0, 0, 0}, 0.5f, 16).build(),
                           {0.7f, 0.5f, 0.3f});
    scene.lights.push_back({.name = "warm", .intensity = {2, 1.5f, 1}, .position = {0.9f, 0.8f, 0.5f}});
    scene.lights.push_back({.name = "cold", .intensity = {0.5f, 1, 2}, .position = {-0.9f, 0.8f, 0.9f}});
    return scene;
}

/// Returns an emissive square that reflects nothing; its material has no name.
prt::Scene shining_square(const glm::vec3& radiance) {
    prt::Scene scene = prt::test::painted(SceneBuilder().floor({0, 0, 0}, 1, 8).build(), glm::vec3(0));
    scene.materials[0].emission.radiance = radiance;
    return scene;
}

prt::BakeOptions bake_options(int rays) {
    prt::BakeOptions options;
    options.order = 3;
    options.rays = rays;
    options.bounces = 1;
    options.tracer.backend = prt::Backend::cpu;
    return options;
}

class LampPictures : public testing::Test {
protected:
    void SetUp() override {
        std::string why;
        context = prt::GlContext::create(prt::GlDevice::any, &why);
        ASSERT_TRUE(context) << why;
        renderer = std::make_unique<FrameRenderer>();
        renderer->resize({kColumns, kRows, 1});
        settings.background = false;
    }
    void TearDown() override {
        gpu.reset();
        renderer.reset();
    }
    /// With its transfer, raw and compressed.
    void load(prt::Scene scene) {
        model = make_model(std::move(scene), "test");
        gpu = std::make_unique<GpuModel>(model);
        view.camera = prt::automatic_camera(model->scene, float{kColumns} / float{kRows}, 0.6f);
        const prt::BakeOptions options = bake_options(64);
        transfer = prt::bake(model->scene, options).baked.transfer;
        gpu->set_raw(transfer);
        gpu->set_compressed(prt::compress(transfer, {model->areas, model->edges},
                                          {.clusters = 8, .coding = prt::preset_u64()})
                                .transfer);
    }
    prt::Image drawn(PictureKind kind, const LampSettings& lamps) {
        gpu->set_lighting({sky}, {}, lamps);
        renderer->draw(1, kind, *gpu, settings, view, {0, kColumns});
        return renderer->read(1, &alpha);
    }
    /// Returns the picture of the renderer of `prt render` from the same camera.
    prt::Picture picture_of(std::span<const glm::vec3> radiance) const {
        return viewer::picture_of(*model, radiance, view.camera, kColumns, kRows);
    }
    bool on_surface(std::size_t pixel) const { return alpha[pixel] == 1; }

    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<FrameRenderer> renderer;
    std::shared_ptr<const Model> model;
    std::unique_ptr<GpuModel> gpu;
    prt::Transfer transfer;
    prt::Light sky = prt::constant_light(3, {0.2f, 0.3f, 0.5f});
    DrawSettings settings;
    FrameView view;
    std::vector<float> alpha;
};

TEST_F(LampPictures, ScaleWithTheStrength) {
    load(lit_scene());
    ASSERT_EQ(transfer.layout.lamps(), 2u);
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed})
        for (const bool deferred : {false, true}) {
            settings.deferred = deferred;
            const prt::Image none = drawn(kind, {.strength = 0}), once = drawn(kind, {.strength = 1}),
                             twice = drawn(kind, {.strength = 2});
            double added = 0, sum = 0;
            for (std::size_t i = 0; i < none.pixels.size(); ++i) {
                const glm::vec3 by_one = once.pixels[i] - none.pixels[i],
                                by_two = twice.pixels[i] - none.pixels[i];
                // Three numbers of half precision, the second doubled: 4 · 2^-12; and constants in it before.
                ASSERT_LT(largest(glm::abs(by_two - 2.0f * by_one)),
                          8.0f / 4096 * largest(twice.pixels[i]) + 1e-6f)
                    << name_of(kind).id << ", pixel " << i;
                added += static_cast<double>(by_one.g);
                sum += static_cast<double>(none.pixels[i].g);
            }
            EXPECT_GT(added, 0.2 * sum) << name_of(kind).id;
        }
}

TEST_F(LampPictures, AreSumsOverTheLampsByName) {
    load(lit_scene());
    const auto only = [](const char* name, const glm::vec3& color) {
        LampSettings lamps{.each = {{.name = "warm", .on = false}, {.name = "cold", .on = false}}};
        LampControl& lamp = *std::ranges::find(lamps.each, name, &LampControl::name);
        lamp.on = true;
        lamp.color = color;
        return lamps;
    };
    for (const PictureKind kind : {PictureKind::prt, PictureKind::prt_compressed}) {
        const prt::Image none = drawn(kind, {.on = false}), warm = drawn(kind, only("warm", glm::vec3(1))),
                         cold = drawn(kind, only("cold", glm::vec3(1))), both = drawn(kind, {}),
                         red = drawn(kind, only("cold", {1, 0, 0}));
        for (std::size_t i = 0; i < none.pixels.size(); ++i) {
            const glm::vec3 sum = warm.pixels[i] + cold.pixels[i] - none.pixels[i];
            ASSERT_LT(largest(glm::abs(sum - both.pixels[i])), 8.0f / 4096 * largest(both.pixels[i]) + 1e-6f);
            ASSERT_NEAR(red.pixels[i].r, cold.pixels[i].r, 1e-3f);
            ASSERT_NEAR(red.pixels[i].b, none.pixels[i].b, 1e-3f);
        }
    }
}

TEST_F(LampPictures, ShowEmissionTimesStrengthInEveryKind) {
    load(shining_square({0.25f, 2, 0.5f}));
    ASSERT_EQ(transfer.layout.lamps(), 1u);
    for (const PictureKind kind : {PictureKind::unshadowed, PictureKind::ssao, PictureKind::ssao_normals,
                                   PictureKind::prt, PictureKind::prt_compressed})
        for (const bool deferred : {false, true})
            for (const float strength : {0.0f, 1.0f, 3.0f}) {
                settings.deferred = deferred;
                const prt::Image image =
                    drawn(kind, {.each = {{.name = "material 0", .strength = strength}}});
                const glm::vec3 expected = strength * glm::vec3(0.25f, 2, 0.5f); // halves hold that exactly
                std::size_t seen = 0;
                for (std::size_t i = 0; i < image.pixels.size(); ++i)
                    if (on_surface(i)) {
                        ASSERT_EQ(image.pixels[i], expected) << name_of(kind).id;
                        ++seen;
                    }
                EXPECT_GT(seen, image.pixels.size() / 10);
            }
}

/// Red, green, blue and white, a texel each, over all of the square.
void add_texture(prt::Scene& scene) {
    const std::vector<glm::u8vec3> texels = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};
    scene.images.push_back({"colors", prt::encode_png(2, 2, texels)});
    scene.materials[0].emission.texture.image = 0;
    for (prt::VertexArray& vertices : scene.vertex_arrays) {
        vertices.texcoords.emplace_back();
        for (const glm::vec3& p : vertices.positions)
            vertices.texcoords.back().emplace_back(0.5f * p.x + 0.5f, 0.5f * p.z + 0.5f);
    }
}

TEST_F(LampPictures, ShowEmissiveTexturesLikeTheRenderer) {
    prt::Scene scene = shining_square({2, 3, 4});
    add_texture(scene);
    load(std::move(scene));
    const std::vector<glm::vec3> nothing(model->scene.receivers(), glm::vec3(0)),
        strengths(model->scene.materials.size(), glm::vec3(0.5f));
    prt::Picture picture = picture_of(nothing);
    picture.emission = strengths;
    const prt::Image expected = prt::render_gl(picture, *context);
    for (const bool deferred : {false, true}) {
        settings.deferred = deferred;
        const prt::Image image = drawn(PictureKind::prt_compressed, {.strength = 0.5f});
        double sum = 0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            ASSERT_LT(largest(glm::abs(image.pixels[i] - expected.pixels[i])), 2e-3f);
            sum += static_cast<double>(glm::abs(image.pixels[i].r / 1.0f - image.pixels[i].g / 1.5f));
        }
        EXPECT_GT(sum, 100); // colors differ
    }
}

TEST_F(LampPictures, UnderASkyShowNoEmission) {
    load(shining_square({0.25f, 2, 0.5f}));
    gpu->set_light(sky);
    renderer->draw(1, PictureKind::prt, *gpu, settings, view, {0, kColumns});
    for (const glm::vec3& pixel : renderer->read(1).pixels)
        EXPECT_EQ(pixel, glm::vec3(0));
}

/// A white floor under a lamp over its middle, baked.
class ViewedLamp : public testing::Test {
protected:
    void SetUp() override {
        prt::test::GlbFile file = prt::test::scene_file(SceneBuilder().floor({0, 0, 0}, 1, 12).build());
        file.json["extensionsUsed"].push_back("KHR_lights_punctual");
        file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 0.2}}};
        for (const char* name : {"Lamp.a", "Lamp.b"}) {
            file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
            file.json["nodes"].push_back({{"name", name},
                                          {"translation", {0, 1.5, 0}},
                                          {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        }
        file.write(folder / "floor.glb");
        prt::GltfDocument document = prt::load_gltf(folder / "floor.glb");
        const prt::Scene scene = prt::extract_scene(document);
        prt::write_transfer(document, scene, prt::bake(scene, bake_options(16)).baked);
        prt::save_glb(document, folder / "baked.glb");
    }
    /// The message with which a script of these steps ends.
    std::string why(const std::string& steps) const {
        try {
            run_script(folder.file("script.json", R"([{"size": [64, 36]}, {"wait": "work"}, )" + steps + "]"),
                       {folder / "baked.glb"});
        } catch (const prt::Error& error) {
            return error.what();
        }
        return "";
    }
    prt::Image8 picture(const char* name) const { return prt::decode_image(prt::read_file(folder / name)); }

    prt::test::TemporaryFolder folder;
};

TEST_F(ViewedLamp, IsSetByScripts) {
    EXPECT_EQ(why(R"(
        {"set": {"panels": false, "left": "prt", "right": "prt_compressed", "split": 0}}, {"no_sky": []},
        {"screenshot": "as_baked.png"},
        {"lamps": {"Lamp.a": 2, "*": 0}}, {"screenshot": "one.png"},
        {"lamps": {"Lamp.a": 0, "Lamp.b": [2, 0, 0]}}, {"screenshot": "red.png"},
        {"keys": "O"}, {"screenshot": "off.png"},
        {"keys": "O"}, {"lamps": {"*": 1}}, {"set": {"lamps": true, "lamp_strength": 1}}, {"screenshot": "again.png"},
        {"set": {"panels": true}}, {"screenshot": "panel.png"}
    )"),
              "");
    // Both lamps have one position, so that one of strength 2 equals both.
    const prt::Image8 both = picture("as_baked.png"), one = picture("one.png"), red = picture("red.png"),
                      off = picture("off.png");
    const std::size_t middle = 18 * 64 + 32;
    EXPECT_GT(both.pixels[middle].g, 60);
    for (std::size_t i = 0; i < both.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(both.pixels[i][c], one.pixels[i][c], 2);
    EXPECT_GT(red.pixels[middle].r, 60);
    EXPECT_EQ(red.pixels[middle].g, 0);
    EXPECT_EQ(off.pixels[middle].r, 0);
    EXPECT_EQ(picture("again.png").pixels, both.pixels);
}

TEST_F(ViewedLamp, IsRejectedWithTheReason) {
    const auto says = [&](const std::string& step, const char* part) {
        const std::string text = why(step);
        EXPECT_NE(text.find(part), std::string::npos) << step << ": " << text;
        EXPECT_NE(text.find("step 3: "), std::string::npos) << text;
    };
    says(R"({"lamps": {"Lamp.c": 1}})", "the model has no lamp 'Lamp.c'; its lamps: Lamp.a, Lamp.b");
    for (const char* strength :
         {"-1", "-1e-9", "2e9", "1e39", "null", "\"NaN\"", "[1, 2]", "[1, 2, -3]", "[1, 2, null]", "true"}) {
        says(std::string(R"({"lamps": {"Lamp.a": )") + strength + "}}", "the strength of 'Lamp.a' is not");
        says(std::string(R"({"lamps": {"*": )") + strength + "}}", "the strength of '*' is not");
    }
    says(R"({"lamps": 3})", "must be an object of names and strengths");
    says(R"({"set": {"lamp_strength": -0.5}})",
         "lamp_strength must be a finite number of at least 0, not -0.5");
    says(R"({"set": {"lamp_strength": 1e39}})", "lamp_strength must be a finite number");
    says(R"({"set": {"lamp_strength": null}})", "must be number");
    // Values that JSON cannot represent do not reach the step.
    EXPECT_NE(why(R"({"lamps": {"*": NaN}})").find("script.json"), std::string::npos);
}

class LampsOfTheViewer : public ViewedLamp {
protected:
    void SetUp() override {
        ViewedLamp::SetUp();
        context = prt::GlContext::create(prt::GlDevice::any);
        ASSERT_TRUE(context);
        viewer = std::make_unique<Viewer>();
        screen = std::make_unique<Offscreen>(kColumns, kRows);
        viewer->settings.panels = false;
        open(folder / "baked.glb");
    }
    void open(const std::filesystem::path& path) {
        viewer->open({path});
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        do {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (viewer->jobs().busy() && std::chrono::steady_clock::now() < end);
        frame();
    }
    void TearDown() override {
        viewer.reset();
        screen.reset();
        context.reset();
    }
    void frame() {
        viewer->update(1.0 / 60);
        viewer->draw(screen->framebuffer(), kColumns, kRows);
    }
    float stops() {
        frame();
        return viewer->lighting().meter.stops();
    }
    LampSettings& lamps() { return viewer->settings.lit.lamps; }

    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<Offscreen> screen;
    std::unique_ptr<Viewer> viewer;
};

TEST_F(LampsOfTheViewer, AreListedWhileTheModelIsOpen) {
    ASSERT_EQ(lamps().each.size(), 2u);
    EXPECT_EQ(lamps().each[0].name, "Lamp.a");
    EXPECT_EQ(lamps().each[1].name, "Lamp.b");
    Controls controls(*viewer);
    EXPECT_TRUE(controls.key('O'));
    EXPECT_FALSE(lamps().on);
    lamps().each[0].strength = 5;
    open(folder / "baked.glb");
    EXPECT_EQ(lamps().each[0].strength, 1);
    prt::test::scene_file(SceneBuilder().floor({0, 0, 0}, 1, 2).build()).write(folder / "other.glb");
    open(folder / "other.glb");
    EXPECT_TRUE(lamps().each.empty());
}

TEST_F(LampsOfTheViewer, AreReportedAsMissingInPicturesWithoutLamps) {
    EXPECT_EQ(viewer->shown(PictureKind::prt).note, "");
    EXPECT_EQ(viewer->shown(PictureKind::prt_compressed).note, "");
    EXPECT_EQ(viewer->shown(PictureKind::reference).note, "without lamps and emission");
    EXPECT_EQ(viewer->shown(PictureKind::unshadowed).note, "without lamps");
    lamps().on = false;
    EXPECT_EQ(viewer->shown(PictureKind::reference).note, "");
    EXPECT_EQ(viewer->shown(PictureKind::unshadowed).note, "");
}

// By day the exposure is fully automatic; at night brighter lamps look brighter: 0.6 of a stop is
// compensated.
TEST_F(LampsOfTheViewer, AreMeteredFullyByDayAndPartlyAtNight) {
    viewer->lights.day = viewer->lights.environment_on = false; // no night either
    frame();
    const float alone = stops();
    lamps().strength = 4;
    EXPECT_NEAR(stops() - alone, -2, 0.01f);
    viewer->lights.day = true;
    viewer->lights.time.hour = 0;
    // About 0.15 and 0.3 of luminance, with 0.01 from the sky.
    lamps().strength = 4;
    const float night = stops();
    EXPECT_LT(night, alone - 2 - 0.3f);
    lamps().strength = 8;
    EXPECT_NEAR(stops() - night, -0.6f, 0.1f);
}

TEST_F(LampsOfTheViewer, LightNumberPictures) {
    viewer->settings.right = PictureKind::error;
    viewer->settings.split = 0;
    const auto error_picture = [&] {
        do {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (viewer->jobs().busy(JobKind::numbers));
        frame();
        return viewer->renderer().read(1);
    };
    viewer->lights.day = viewer->lights.environment_on = false;
    const prt::Image once = error_picture();
    lamps().strength = 4; // an equal fraction of the light
    EXPECT_EQ(error_picture().pixels, once.pixels);
    viewer->lights.day = true; // a different light
    EXPECT_NE(error_picture().pixels, once.pixels);
}

} // namespace
} // namespace viewer
