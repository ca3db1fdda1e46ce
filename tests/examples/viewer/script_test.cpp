// Tests scripts, which control everything that the window controls.

#include "script/script.h"

#include "prt/bake/bake.h"
#include "prt/compress/compress.h"
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace viewer {
namespace {

class Script : public testing::Test {
protected:
    void SetUp() override {
        prt::test::scene_file(
            prt::test::SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 10).sphere({0, 0, 0}, 0.5f, 12).build())
            .write(folder / "ball.glb");
    }
    /// Returns the files with raw and compressed transfer, so that nothing needs to be baked.
    std::vector<std::filesystem::path> with_transfer() const {
        prt::GltfDocument document = prt::load_gltf(folder / "ball.glb");
        const prt::Scene scene = prt::extract_scene(document);
        prt::BakeOptions bake_options;
        bake_options.order = 3;
        bake_options.rays = 16;
        bake_options.tracer.backend = prt::Backend::cpu;
        const prt::BakedTransfer baked = prt::bake(scene, bake_options).baked;
        prt::write_transfer(document, scene, baked);
        prt::save_glb(document, folder / "baked.glb");
        prt::CompressOptions options;
        options.clusters = 8;
        options.coding.components = 2;
        prt::write_clustered(
            document, scene,
            {prt::compress(baked.transfer, {prt::receiver_areas(scene)}, options).transfer, baked.record});
        prt::save_glb(document, folder / "shipped.glb");
        return {folder / "baked.glb", folder / "shipped.glb"};
    }
    void run(const std::string& steps, const std::vector<std::filesystem::path>& files = {}) const {
        run_script(folder.file("script.json", steps), files);
    }
    /// The message with which it ends.
    std::string why(const std::string& steps) const {
        try {
            run(steps);
        } catch (const prt::Error& error) {
            return error.what();
        }
        return "";
    }
    nlohmann::json json(const char* name) const {
        const auto bytes = prt::read_file(folder / name);
        return nlohmann::json::parse(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    prt::Image8 picture(const char* name) const { return prt::decode_image(prt::read_file(folder / name)); }

    prt::test::TemporaryFolder folder;
};

TEST_F(Script, OpensWaitsDrawsAndReports) {
    run(R"([
        {"size": [320, 180]}, {"wait": "work"},
        {"set": {"left": "unshadowed", "right": "prt", "difference": true, "panels": false}},
        {"figures": "figures.json"}, {"screenshot": "difference.png"},
        {"set": {"left": "prt", "right": "prt"}}, {"figures": "same.json"},
        {"set": {"difference": false, "split": 0.5}}, {"screenshot": "split.png"},
        {"lose_context": []}, {"screenshot": "again.png"},
        {"compress": {"order": 3, "clusters": 4, "components": 1}}, {"draw": 1}, {"wait": "work"},
        {"set": {"right": "prt_compressed"}}, {"figures": "compressed.json"},
        {"set": {"panels": true, "help": true}}, {"screenshot": "panels.png"}
    ])",
        {folder / "ball.glb"});
    EXPECT_EQ(json("figures.json")["order"], 6);
    EXPECT_GT(json("figures.json")["difference_relative_l2"].get<double>(), 0.02);
    EXPECT_EQ(json("same.json")["difference_relative_l2"].get<double>(), 0);
    EXPECT_EQ(json("compressed.json")["order"], 3);
    EXPECT_LE(json("compressed.json")["clusters"].get<int>(), 4);
    EXPECT_EQ(picture("split.png").width, 320);
    EXPECT_EQ(picture("split.png").pixels, picture("again.png").pixels);
    EXPECT_NE(picture("split.png").pixels, picture("difference.png").pixels);
    EXPECT_NE(picture("split.png").pixels, picture("panels.png").pixels);
}

TEST_F(Script, KeysAndPointerWorkAsInTheWindow) {
    run(R"([
        {"size": [320, 180]}, {"wait": "work"}, {"set": {"panels": false, "split": 0}},
        {"screenshot": "a.png"},
        {"press": ["right", 100, 100]}, {"move": [190, 100]}, {"release": []}, {"screenshot": "turned.png"},
        {"rotate": 90}, {"screenshot": "same.png"},
        {"press": ["left", 100, 100]}, {"move": [150, 120]}, {"release": []}, {"scroll": 2}, {"screenshot": "moved.png"},
        {"keys": "W"}, {"screenshot": "wires.png"},
        {"light": {"kind": "cone", "direction": [0, 1, 0], "size": 0.3, "strength": 20}}, {"draw": 1},
        {"hover": [160, 90]}, {"set": {"lobe": true}}, {"screenshot": "lobe.png"}, {"spin": 5}, {"no_sky": []}, {"draw": 2}
    ])",
        {folder / "ball.glb"});
    EXPECT_NE(picture("a.png").pixels, picture("turned.png").pixels);
    // Half the window's height is a quarter rotation; the last bit of a pixel may differ.
    const prt::Image8 rotated = picture("turned.png"), same = picture("same.png");
    for (std::size_t i = 0; i < same.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(rotated.pixels[i][c], same.pixels[i][c], 1);
    EXPECT_NE(picture("moved.png").pixels, same.pixels);
    EXPECT_NE(picture("wires.png").pixels, picture("moved.png").pixels);
    EXPECT_NE(picture("lobe.png").pixels, picture("wires.png").pixels);
}

/// True if the two pictures are equal in the rectangle.
bool same(const prt::Image8& a, const prt::Image8& b, const glm::ivec2& low, const glm::ivec2& high) {
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            if (a.pixels[static_cast<std::size_t>(y * a.width + x)] !=
                b.pixels[static_cast<std::size_t>(y * b.width + x)])
                return false;
    return true;
}

TEST_F(Script, EscapeClosesADropDownAndTipsExplainControls) {
    run(R"([
        {"size": [440, 300]}, {"wait": "work"}, {"hover": [430, 20]}, {"screenshot": "before.png"},
        {"press": ["left", 100, 70]}, {"release": []}, {"draw": 2}, {"hover": [430, 20]}, {"screenshot": "open.png"},
        {"keys": "\u001b"}, {"draw": 3}, {"screenshot": "closed.png"},
        {"hover": [100, 139]}, {"screenshot": "tip.png"}
    ])",
        with_transfer());
    const glm::ivec2 low(20, 110), high(210, 150); // below the drop-down, above all figures
    EXPECT_FALSE(same(picture("before.png"), picture("open.png"), low, high));
    EXPECT_TRUE(same(picture("before.png"), picture("closed.png"), low, high));
    // next to the panel
    EXPECT_FALSE(same(picture("before.png"), picture("tip.png"), {330, 100}, {420, 200}));
}

TEST_F(Script, PicturesOfNumbersHaveALegend) {
    run(R"([
        {"size": [640, 360]}, {"wait": "work"}, {"set": {"panels": false, "split": 0, "background": false}},
        {"set": {"right": "components"}}, {"draw": 1}, {"wait": "numbers"}, {"screenshot": "components.png"},
        {"set": {"right": "seams"}}, {"draw": 1}, {"wait": "numbers"}, {"screenshot": "seams.png"}
    ])",
        with_transfer());
    for (const char* name : {"components.png", "seams.png"}) {
        // From black over red and yellow to white, left to right.
        const prt::Image8 shown = picture(name);
        const auto at = [&](int x) { return shown.pixels[static_cast<std::size_t>((360 - 64) * 640 + x)]; };
        EXPECT_LT(at(13).r, 60) << name;
        EXPECT_LT(at(13).g, 10) << name;
        int row = 0, brightest = 0;
        for (int x = 13; x < 600; ++x) {
            const int sum = at(x).r + at(x).g + at(x).b;
            if (sum < brightest - 3)
                break;
            brightest = sum;
            ++row;
        }
        EXPECT_GT(row, 150) << name;
        EXPECT_GT(brightest, 3 * 240) << name;
    }
}

TEST_F(Script, TheScaleOfTheDisplayMakesPanelsLarger) {
    run(R"([
        {"size": [800, 450]}, {"wait": "work"}, {"set": {"background": false}},
        {"screenshot": "one.png"}, {"scale": 2}, {"draw": 1}, {"screenshot": "two.png"}
    ])",
        with_transfer());
    // The panel's title reaches twice as far: blue at 500 pixels from the left, 30 from the top.
    const auto at = [&](const char* name, int x, int y) {
        return picture(name).pixels[static_cast<std::size_t>(y * 800 + x)];
    };
    EXPECT_GT(at("one.png", 300, 13).b, 60);
    EXPECT_LT(at("one.png", 500, 30).b, 60);
    EXPECT_GT(at("two.png", 500, 30).b, 60);
}

TEST_F(Script, MeasuresTheErrorBudget) {
    run(R"([
        {"size": [160, 90]}, {"wait": "work"}, {"no_sky": []},
        {"set": {"panels": false, "split": 0, "background": false}},
        {"light": {"kind": "hemisphere", "direction": [0, 1, 0], "strength": 1}}, {"budget": "even.json"},
        {"set": {"right": "surface_error"}}, {"screenshot": "even.png"},
        {"light": {"kind": "sun", "direction": [0.5, 1, 0], "strength": 3}}, {"draw": 1}, {"wait": "budget"},
        {"screenshot": "sun.png"}, {"budget": "apart.json"},
        {"set": {"separate_suns": false}}, {"draw": 1}, {"budget": "bands.json"}, {"lose_context": []}, {"draw": 2}
    ])",
        with_transfer());
    for (const char* name : {"even.json", "apart.json", "bands.json"}) {
        const nlohmann::json budget = json(name);
        double sum = 0;
        for (const auto& cause : budget["causes"])
            sum += cause["squared"].get<double>();
        const double total = budget["total"]["squared"].get<double>(),
                     together = budget["squared_together"].get<double>();
        EXPECT_GT(total, 0) << name;
        EXPECT_NEAR(sum + together, total, 1e-9) << name;
        // Interactions between causes are smaller than half of the total if several causes have similar size.
        EXPECT_LT(std::abs(together), 0.5 * total) << name;
        EXPECT_GT(budget["causes"]["bytes"]["squared"].get<double>(), 0) << name;
        EXPECT_GT(budget["causes"]["rays"]["squared"].get<double>(), 0) << name;
    }
    const auto light = [&](const char* name) { return json(name)["causes"]["light"]["error"].get<double>(); };
    EXPECT_LT(light("even.json"), 0.01);                     // two bands hold a hemisphere light
    EXPECT_GT(light("bands.json"), 2 * light("apart.json")); // three hold no sun
    EXPECT_NE(picture("even.png").pixels, picture("sun.png").pixels);
}

TEST_F(Script, SavesTheCompressedModel) {
    run(R"([{"wait": "work"}, {"save": "kept.glb"}, {"open": "kept.glb"}, {"wait": "work"}, {"figures": "f.json"}])",
        with_transfer());
    EXPECT_GT(json("f.json")["bytes_per_vertex"].get<double>(), 0);
}

TEST_F(Script, ReportsErrorsWithTheirStep) {
    EXPECT_NE(why("[{\"set\": ").find("script.json: "), std::string::npos);
    EXPECT_NE(why("{}").find("an array of steps"), std::string::npos);
    EXPECT_NE(why("[{\"draw\": 1}, {\"dance\": 1}]").find("step 2: unknown step 'dance'"), std::string::npos);
    EXPECT_NE(why("[{\"draw\": \"often\"}]").find("step 1: "), std::string::npos);
    EXPECT_NE(why("[{\"set\": {\"left\": \"nothing\"}}]").find("unknown picture 'nothing'"),
              std::string::npos);
    EXPECT_NE(why("[{\"light\": {\"kind\": \"torch\"}}]").find("unknown light 'torch'"), std::string::npos);
    EXPECT_NE(why("[{\"keys\": \"\\u0001\"}]").find("unknown key"), std::string::npos);
    EXPECT_NE(why("[{\"size\": [0, 5]}]").find("above 0"), std::string::npos);
    EXPECT_NE(why("[7]").find("one member"), std::string::npos);
    EXPECT_THROW(run_script(folder / "missing.json", {}), prt::Error);
}

TEST_F(Script, FailsOnUnexpectedMessages) {
    EXPECT_NE(why(R"([{"open": "missing.glb"}, {"wait": "work"}])").find("missing.glb"), std::string::npos);
    EXPECT_EQ(why(R"([{"open": "missing.glb"}, {"expect_message": "missing.glb"}, {"draw": 1}])"), "");
    EXPECT_NE(why(R"([{"open": "missing.glb"}, {"expect_message": "sunshine"}])")
                  .find("no message contains 'sunshine'"),
              std::string::npos);
}

} // namespace
} // namespace viewer
