// prt render --path-trace: closed forms, and the pictures of the demo against it.

#include "pipeline.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <regex>
#include <sstream>

namespace prt::test {
namespace {

class PathTraced : public Pipeline {
protected:
    void SetUp() override {
        scene_file(SceneBuilder().floor({0, 0, 0}, 2, 8).build()).write(folder / "floor.glb");
        write_exr(folder / "even.exr", Image{2, 1, {glm::vec3(0.7f), glm::vec3(0.7f)}},
                  EnvironmentLayout::lat_long);
    }

    /// Mean of the picture of `model` from above.
    glm::vec3 seen(const char* model, std::vector<std::string> light) const {
        std::vector<std::string> arguments = {"render", at(model),  "-o",           at("p.exr"), "--size",
                                              "24x24",  "--camera", "0.01,1,0",     "--look-at", "0,0,0",
                                              "--fov",  "10",       "--path-trace", "64"};
        arguments.insert(arguments.end(), light.begin(), light.end());
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const Image image =
            load_environment(folder / "p.exr", {EnvironmentLayout::lat_long, BadPixels::error})
                .environment.image;
        glm::vec3 sum(0);
        for (const glm::vec3& pixel : image.pixels)
            sum += pixel / static_cast<float>(image.pixels.size());
        return sum;
    }
};

TEST_F(PathTraced, FloorsMatchTheirLight) {
    // Under radiance 0.7 a floor of albedo 1 reflects 0.7; a sun of irradiance 2 at 60 degrees adds 2 cos 60
    // / pi.
    EXPECT_NEAR(seen("floor.glb", {"--lights", at("even.exr")}).g, 0.7, 0.01);
    nlohmann::json light = {{"prtkit_light", 1}, {"order", 6}};
    for (const char* channel : {"red", "green", "blue"})
        light["coefficients"][channel] = std::vector<float>(36, 0.0f);
    light["suns"] = {
        {{"towards", {std::sqrt(0.75), 0.5, 0}}, {"irradiance", {2, 1, 0}}, {"half_angle_radians", 0.02}}};
    folder.file("sun.json", light.dump());
    const glm::vec3 lit = seen("floor.glb", {"--lights", at("sun.json")});
    EXPECT_NEAR(lit.r, 1 / std::numbers::pi, 2e-3);
    EXPECT_NEAR(lit.g, 0.5 / std::numbers::pi, 1e-3);
}

TEST_F(PathTraced, LampsOfASceneWithoutTransferEmit) {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 2, 8).build());
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "bulb"}, {"intensity", 3}}};
    file.json["nodes"].push_back(
        {{"translation", {0, 2, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size() - 1);
    file.write(folder / "lamp.glb");
    // Intensity 3 from 2 m above.
    EXPECT_NEAR(seen("lamp.glb", {}).g, 3 / (4 * std::numbers::pi), 3e-3);
    EXPECT_EQ(seen("lamp.glb", {"--lamp-strengths", "off"}).g, 0);
}

TEST_F(PathTraced, ErrorsAreSmallForABakeAndGreatWithoutShadows) {
    scene_file(SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 24).sphere({0, 0, 0}, 0.5f, 24).build())
        .write(folder / "ball.glb");
    Image sky{16, 8, {}};
    for (int i = 0; i < 16 * 8; ++i)
        sky.pixels.emplace_back(i / 16 < 4 ? (i % 16 < 4 ? 3.0f : 0.5f) : 0.1f);
    write_exr(folder / "sky.exr", sky, EnvironmentLayout::lat_long);
    ASSERT_EQ(prt({"bake", at("ball.glb"), "-o", at("b.glb"), "--rays", "256", "--bounces", "inf"}).status,
              0);
    const auto error = [&](const char* model, const char* rotation) {
        const Outcome outcome = prt({"render", at(model), "--lights", at("sky.exr"), "-o", at("e.png"),
                                     "--size", "64x40", "--path-trace", "32", "--show", "error", "--rotate",
                                     rotation, "--json", at("e.json"), "--device", "cpu"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return read_json(folder / "e.json");
    };
    for (const char* rotation : {"0", "135"}) {
        const auto baked = error("b.glb", rotation), unshadowed = error("ball.glb", rotation);
        EXPECT_LT(baked["contrast_percentile_95"], 0.1) << rotation;
        EXPECT_GT(unshadowed["contrast_percentile_95"], 0.2) << rotation;
        EXPECT_LT(baked["flip_mean"], unshadowed["flip_mean"]) << rotation;
        EXPECT_LT(baked["noise_relative_l2"], 0.2);
    }
    const Image8 picture = decode_image(read_file(folder / "e.png"));
    EXPECT_EQ(picture.width, 64);
    EXPECT_EQ(glm::vec3(picture.pixels.front()), glm::vec3(0)); // the sky is not compared
}

TEST_F(PathTraced, IncompatibleOptionsAreRejected) {
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"--show", "error"},
          {"--show", "ao", "--path-trace", "8"},
          {"--show", "error", "--path-trace", "8", "--baked", at("floor.glb")},
          {"--path-trace", "1"},
          {"--baked", at("floor.glb")}}) {
        std::vector<std::string> arguments = {"render", at("floor.glb"), "--lights", at("even.exr"),
                                              "-o",     at("p.png")};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 2) << wrong[0];
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

/// A picture of demo.sh: a line that begins with `road` or `made` after variables.
struct DemoPicture {
    std::string name, way, bounces = "inf", preset, sky = "sky";
    std::vector<std::string> camera;
};

std::vector<DemoPicture> demo_pictures() {
    std::vector<DemoPicture> pictures;
    std::ifstream script(PRT_DEMO);
    const std::regex line_form(R"(^((?:\w+=\S+ )*)(road|made) (\w+)(.*)$)"),
        sky_update(R"(sky=out/scenes/(\w+)\.exr)");
    for (std::string line; std::getline(script, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, line_form))
            continue;
        DemoPicture picture{.name = match[3], .way = match[2], .preset = {}, .camera = {}};
        const std::string variables = match[1];
        if (std::smatch sky; std::regex_search(variables, sky, sky_update))
            picture.sky = sky[1];
        std::istringstream rest(match[4].str());
        if (picture.way == "road")
            rest >> picture.bounces >> picture.preset;
        for (std::string word; rest >> word;)
            picture.camera.push_back(word);
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

class DemoPictures : public Pipeline, public testing::WithParamInterface<DemoPicture> {};
INSTANTIATE_TEST_SUITE_P(All, DemoPictures, testing::ValuesIn(demo_pictures()),
                         [](const auto& picture) { return picture.param.name; });

// Means over blocks of 8 x 8 pixels against path tracing, of pictures a twelfth as wide as the demo's. Bakes
// measure 3 to 7 %, noise of 64 paths included; the night room of a compressor that destroys faint light 27
// %.
TEST_P(DemoPictures, MatchPathTracing) {
    const DemoPicture& picture = GetParam();
    copy_examples(folder.path(), {picture.name, picture.sky});
    const std::string scene = at((picture.name + ".glb").c_str()), sky = at((picture.sky + ".exr").c_str());
    if (picture.way == "road") {
        ASSERT_EQ(
            prt({"bake", scene, "-o", at("b.glb"), "--rays", "128", "--bounces", picture.bounces}).status, 0);
        ASSERT_EQ(prt({"compress", at("b.glb"), "-o", at("c.glb"), "--preset", picture.preset}).status, 0);
    } else {
        ASSERT_EQ(prt({"make", scene, "-o", at("c.glb"), "--lights", sky, "--max-error", "0.03"}).status, 0);
    }
    std::vector<std::string> arguments = {"render", at("c.glb"),  "--lights",     sky,  "-o",     at("e.png"),
                                          "--size", "108x60",     "--path-trace", "64", "--show", "error",
                                          "--json", at("e.json"), "--device",     "cpu"};
    arguments.insert(arguments.end(), picture.camera.begin(), picture.camera.end());
    const Outcome outcome = prt(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto report = read_json(folder / "e.json");
    EXPECT_LT(report["contrast_percentile_95"], 0.1) << outcome.out;
    EXPECT_LT(report["flip_mean"], 0.15) << outcome.out;
}

} // namespace
} // namespace prt::test
