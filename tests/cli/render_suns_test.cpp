// Tests prt render under skies with suns: separate and combined suns, and the notices about them.

#include "program.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>

namespace prt::test {
namespace {

/// A floor under a roof that covers x > 1; the camera sees the floor from below the roof.
class RenderSuns : public testing::Test {
protected:
    void SetUp() override {
        scene_file(
            SceneBuilder().floor({0, 0, 0}, 3, 12).quad({1, 2, -3}, {1, 2, 3}, {3, 2, 3}, {3, 2, -3}).build())
            .write(folder / "s.glb");
        prt_once("b.glb", {"bake", at("s.glb"), "--rays", "256", "--order", "4"}, folder / "b.glb");
        prt_once("c.glb", {"compress", at("b.glb")}, folder / "c.glb");
        prt_once("w.glb", {"compress", at("b.glb"), "--combine-direct"}, folder / "w.glb");
        // Black except for a green sun overhead of irradiance 0.4 pi.
        nlohmann::json light = {{"prtkit_light", 1}, {"order", 6}};
        for (const char* channel : {"red", "green", "blue"})
            light["coefficients"][channel] = std::vector<double>(36, 0.0);
        light["suns"] = {{{"towards", {0, 2, 0}},
                          {"irradiance", {0, 0.4 * std::numbers::pi, 0}},
                          {"half_angle_radians", 0.005}}};
        folder.file("sun.json", light.dump());
        Image sky{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(0.2f))};
        write_exr(folder / "plain.exr", sky, EnvironmentLayout::lat_long);
        sky.at(20, 3) = glm::vec3(400);
        write_exr(folder / "sunny.exr", sky, EnvironmentLayout::lat_long);
    }
    std::string at(const char* name) const { return (folder / name).string(); }
    Outcome render(std::vector<std::string> arguments) const {
        for (const char* a : {"--size", "64x32", "--camera", "0.7,1.5,0.001", "--look-at", "0.7,0,0", "--fov",
                              "40", "--device", backend})
            arguments.emplace_back(a);
        arguments.insert(arguments.begin(), "render");
        return prt(arguments);
    }
    Image rendered(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"-o", at("p.exr")});
        const Outcome outcome = render(std::move(arguments));
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return load_environment(folder / "p.exr").environment.image;
    }

    nlohmann::json report() const {
        std::ifstream file(folder / "r.json");
        return nlohmann::json::parse(file);
    }

    TemporaryFolder folder;
    const char* backend = "cpu";
};

/// The shadow of the roof starts at x = 1; pixels of 3 cm resolve it.
TEST_F(RenderSuns, HaveSharpShadowsByRaysAndMaps) {
    for (const auto& [model, by] : {std::pair("s.glb", "cpu"), // without transfer
                                    {"b.glb", "cpu"},
                                    {"c.glb", "cpu"},
                                    {"s.glb", "gpu"},
                                    {"b.glb", "gpu"},
                                    {"c.glb", "gpu"}}) {
        backend = by;
        const Image image = rendered({at(model), "--lights", at("sun.json")});
        ASSERT_EQ(image.width, 64);
        const int edge = 32 + static_cast<int>(0.3 * 16 / (1.5 * std::tan(20 * std::numbers::pi / 180)));
        for (int x = 0; x < edge - 1; ++x)
            EXPECT_LT(glm::distance(image.at(x, 16), glm::vec3(0, 0.4f, 0)), 1e-3f) << model << x;
        for (int x = edge + 2; x < image.width; ++x)
            EXPECT_LT(glm::length(image.at(x, 16)), 1e-6f) << model << x;
    }
}

TEST_F(RenderSuns, LightCombinedTransferWithTheSky) {
    const Image separate = rendered({at("b.glb"), "--lights", at("sun.json")}),
                together = rendered({at("b.glb"), "--lights", at("sun.json"), "--suns", "0"});
    EXPECT_LT(separate.at(44, 16).g, 1e-6f);
    EXPECT_GT(together.at(44, 16).g, 0.005f); // order 4 blurs the shadow's edge
    for (const char* sky : {"sun.json", "sunny.exr"}) {
        const Outcome outcome = render({at("w.glb"), "--lights", at(sky), "-o", at("w.exr")});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.err.find("has no separate direct term"), std::string::npos) << outcome.err;
        const Image none = rendered({at("w.glb"), "--lights", at(sky), "--suns", "0"});
        EXPECT_EQ(load_environment(folder / "w.exr").environment.image.pixels, none.pixels) << sky;
    }
    const Outcome none = render({at("w.glb"), "--lights", at("plain.exr"), "-o", at("w.exr")});
    EXPECT_EQ(none.err.find("separate direct"), std::string::npos) << none.err; // no notice is needed
}

/// If the whole floor is marble, the sun and its shadow come only through transfer.
TEST_F(RenderSuns, LightMediaThroughTransfer) {
    ASSERT_EQ(prt({"bake", at("s.glb"), "-o", at("m.glb"), "--rays", "256", "--order", "4", "--subsurface",
                   "marble"})
                  .status,
              0);
    // Both without a window, because a window filters only the sky and not separate suns.
    const Image separate = rendered({at("m.glb"), "--lights", at("sun.json"), "--window", "none"}),
                together =
                    rendered({at("m.glb"), "--lights", at("sun.json"), "--suns", "0", "--window", "none"});
    for (std::size_t i = 0; i < separate.pixels.size(); ++i)
        ASSERT_LT(glm::distance(separate.pixels[i], together.pixels[i]), 1e-4f);
}

/// A medium of --subsurface beside another material: transfer has a direct term, and the file names the
/// medium, so that no renderer adds suns to it.
TEST_F(RenderSuns, LightMediaOfCompressedFilesOnce) {
    GlbFile file = read_glb(folder / "s.glb");
    file.json["materials"] = {{{"name", "Wax"}}, {{"name", "Stone"}}};
    file.json["meshes"].push_back(file.json["meshes"][0]);
    for (std::size_t m = 0; m < 2; ++m)
        file.json["meshes"][m]["primitives"][0]["material"] = m;
    file.json["nodes"].push_back({{"mesh", 1}, {"translation", {40, 0, 0}}});
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json.erase("buffers");
    file.write(folder / "two.glb");
    ASSERT_EQ(prt({"bake", at("two.glb"), "-o", at("m.glb"), "--rays", "256", "--order", "4", "--subsurface",
                   "Wax=marble"})
                  .status,
              0);
    ASSERT_EQ(prt({"compress", at("m.glb"), "-o", at("mc.glb"), "--clusters", "4", "--bits", "100"}).status,
              0);
    EXPECT_EQ(set_of(read_glb(folder / "mc.glb").json, "vertices").at("bake").at("media"),
              nlohmann::ordered_json({"Wax"}));
    for (const char* device : {"cpu", "gpu"}) {
        const auto image = [&](const char* suns) {
            std::vector<std::string> arguments = {
                "render",   at("mc.glb"), "--lights", at("sun.json"),  "--window",  "none",    "--suns", suns,
                "--size",   "64x32",      "--camera", "0.7,1.5,0.001", "--look-at", "0.7,0,0", "--fov",  "40",
                "--device", device,       "-o",       at("p.exr")};
            const Outcome outcome = prt(arguments);
            EXPECT_EQ(outcome.status, 0) << outcome.err;
            return load_environment(folder / "p.exr").environment.image;
        };
        const Image separate = image("1"), together = image("0");
        double brightest = 0;
        for (std::size_t i = 0; i < separate.pixels.size(); ++i) {
            ASSERT_LT(glm::distance(separate.pixels[i], together.pixels[i]), 2e-3f) << device;
            brightest = std::max(brightest, static_cast<double>(together.pixels[i].g));
        }
        EXPECT_GT(brightest, 0.1) << device; // the sun lights the floor
    }
}

/// A sky without suns is lit as it was before there were any.
TEST_F(RenderSuns, DoNotChangePlainSkies) {
    const Image found = rendered({at("c.glb"), "--lights", at("plain.exr")}),
                none = rendered({at("c.glb"), "--lights", at("plain.exr"), "--suns", "0"});
    EXPECT_EQ(found.pixels, none.pixels);
}

TEST_F(RenderSuns, AreReported) {
    const Outcome outcome = render(
        {at("c.glb"), "--lights", at("sunny.exr"), "-o", at("p.png"), "--json", at("r.json"), "--suns", "2"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(report()["suns"], 1); // there is but one
    EXPECT_NE(outcome.out.find("1 separate sun"), std::string::npos) << outcome.out;
}

/// If all light comes from a sun, the picture has the usual brightness.
TEST_F(RenderSuns, CountForTheExposure) {
    const Outcome outcome =
        render({at("s.glb"), "--lights", at("sun.json"), "-o", at("p.png"), "--json", at("r.json")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    // Some 0.7 of the picture at green 0.4: its luminance becomes 0.22.
    EXPECT_NEAR(report()["exposure_stops"].get<double>(), std::log2(0.22 / (0.7 * 0.4 * 0.7152)), 0.4);
}

/// Under a sky with only a sun, transfer contributes only bounced light, and here there is none; relative to
/// the light of the whole sun its error is zero, and the verdict reports this.
TEST_F(RenderSuns, AreSeparateInTheVerdict) {
    const auto rows = [&](const char* shipped, const char* sky) {
        const Outcome outcome =
            prt({"evaluate", at("b.glb"), at(shipped), "--lights", at(sky), "--json", at("r.json")});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const nlohmann::json all = report();
        nlohmann::json found = {{"verdict", all["verdict"]}};
        for (const nlohmann::json& row : all["lights"])
            found[row["light"].get<std::string>()] = row;
        return found;
    };
    const auto sun = rows("c.glb", "sun.json");
    EXPECT_GT(sun["sun.json"]["lit_rms"], 0);
    EXPECT_FALSE(sun["sun.json"]["in_verdict"]);
    EXPECT_EQ(sun["sun.json, separate suns"]["lit_rms"], 0);
    EXPECT_EQ(sun["sun.json, separate suns"]["separate_suns"], 1);
    EXPECT_TRUE(sun["sun.json, separate suns"]["in_verdict"]);
    EXPECT_NE(sun["verdict"].get<std::string>().find("0.00 % under sun.json, separate suns"),
              std::string::npos)
        << sun["verdict"];
    const auto sky = rows("c.glb", "sunny.exr");
    EXPECT_LT(sky["sunny.exr, separate suns"]["lit_rms"], sky["sunny.exr"]["lit_rms"]);
    EXPECT_FALSE(rows("c.glb", "plain.exr").contains("plain.exr, separate suns"));
    const auto whole = rows("w.glb", "sunny.exr");
    EXPECT_FALSE(whole.contains("sunny.exr, separate suns"));
    EXPECT_TRUE(whole["sunny.exr"]["in_verdict"]);
}

TEST_F(RenderSuns, ReportUnsupportedInput) {
    const auto refused = [&](std::vector<std::string> arguments, int status, const char* words) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), {"-o", at("no.png")});
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, status) << outcome.err;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no.png"));
    };
    refused({at("w.glb"), "--lights", at("sun.json"), "--suns", "1"}, 1, "no separate direct term");
    std::ifstream file(folder / "sun.json");
    nlohmann::json five = nlohmann::json::parse(file);
    five["suns"] = std::vector<nlohmann::json>(5, five["suns"][0]);
    folder.file("five.json", five.dump());
    refused({at("b.glb"), "--lights", at("five.json"), "--device", "gpu"}, 1, "at most 4 suns, not 5");
    refused({at("b.glb"), "--lights", at("sunny.exr"), "--suns", "many"}, 2, "many");
    refused({at("b.glb"), "--lights", at("sunny.exr"), "--suns", "rays=0"}, 2, "rays=0");
}

} // namespace
} // namespace prt::test
