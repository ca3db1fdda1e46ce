// Tests lamps of a scene through the pipeline, from the file to lit vertices.

#include "program.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/lightmap_model.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>

namespace prt::test {
namespace {

constexpr float kHeight = 1.5f;

/// Returns a floor under a white lamp of intensity 2, and a second lamp with another name.
GlbFile floor_with_lamps() {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 1, 6).build());
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 2}}, {{"type", "point"}, {"intensity", 1}, {"color", {1, 0, 0}}}};
    const auto add = [&](const char* name, int light, const std::vector<float>& position) {
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back({{"name", name},
                                      {"translation", position},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    };
    add("Lamp.white", 0, {0, kHeight, 0});
    add("Lamp.red", 1, {0.5f, kHeight, 0});
    return file;
}

class LampCommands : public testing::Test {
protected:
    void SetUp() override {
        floor_with_lamps().write(folder / "s.glb");
        bake("b.glb", {});
    }
    std::string at(const std::string& name) const { return (folder / name).string(); }
    void bake(const std::string& name, const std::vector<std::string>& more) const {
        std::vector<std::string> all = {"bake", at("s.glb"), "-o", at(name), "--rays", "64", "--order", "3"};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = prt(all);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
    /// Names of the lamps of a file.
    std::vector<std::string> lamps_of(const std::string& name) const {
        EXPECT_EQ(prt({"info", at(name), "--json", at("i.json")}).status, 0);
        const auto info = nlohmann::json::parse(std::ifstream(folder / "i.json"));
        const auto& transfer = info.contains("transfer") ? info["transfer"] : info["clustered_pca"];
        std::vector<std::string> names;
        for (const auto& term : transfer["terms"])
            if (term["kind"] == "lamp")
                names.push_back(term["name"]);
        return names;
    }
    /// Returns the lit vertices, without a sky.
    VertexArray lit(const std::string& model, const std::string& strengths) const {
        const Outcome outcome =
            prt({"relight", at(model), "-o", at("lit.glb"), "--lamp-strengths", strengths});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return extract_scene(load_gltf(folder / "lit.glb")).vertex_arrays[0];
    }

    TemporaryFolder folder;
};

TEST_F(LampCommands, AreScaledInTheFile) {
    bake("scaled.glb", {"--lamp-scale", "0.25"});
    const Scene before = extract_scene(load_gltf(folder / "b.glb")),
                after = extract_scene(load_gltf(folder / "scaled.glb"));
    ASSERT_EQ(after.lights.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(after.lights[i].intensity, 0.25f * before.lights[i].intensity);
    const VertexArray whole = lit("b.glb", "on"), term = lit("scaled.glb", "on");
    for (std::size_t v = 0; v < whole.size(); ++v)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(term.colors[v][c], 0.25f * whole.colors[v][c], 1e-3f);
    EXPECT_EQ(prt({"bake", at("s.glb"), "-o", at("n.glb"), "--lamp-scale", "-1"}).status, 2);
}

TEST_F(LampCommands, PhotometricUnitsAreReported) {
    GlbFile bright = floor_with_lamps();
    bright.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 2 * 683;
    bright.write(folder / "s.glb");
    const auto notice = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = {"bake",   at("s.glb"), "-o",      at("n.glb"),
                                        "--rays", "64",        "--order", "3"};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = prt(all);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.err.find("--lamp-scale 0.00146") != std::string::npos;
    };
    EXPECT_TRUE(notice({}));
    EXPECT_FALSE(notice({"--lamp-scale", "0.00146"}));
    EXPECT_FALSE(notice({"--lamps", "none"}));
    // The bake of them, drawn under a sky.
    bake("bright.glb", {});
    const std::vector<int> uniform = {1, 0, 0, 0, 0, 0, 0, 0, 0};
    const nlohmann::json sky = {{"prtkit_light", 1},
                                {"order", 3},
                                {"coefficients", {{"red", uniform}, {"green", uniform}, {"blue", uniform}}}};
    folder.file("sky.json", sky.dump());
    const Outcome drawn = prt({"render", at("bright.glb"), "-o", at("p.png"), "--size", "32x32", "--device",
                               "cpu", "--lights", at("sky.json")});
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_NE(drawn.err.find("--lamp-scale 0.00146"), std::string::npos) << drawn.err;
}

/// A dim lamp over a floor of two triangles, a bright one over a fine floor.
TEST_F(LampCommands, ObjectsWithHighErrorAreReported) {
    GlbFile file = scene_file(SceneBuilder().floor({8, 0, 0}, 2, 24).build());
    const Scene coarse = SceneBuilder().floor({0, 0, 0}, 2, 1).build();
    const VertexArray& floor = coarse.vertex_arrays[0];
    const auto& triangles = coarse.primitives[0].triangles;
    const auto floats = [](const std::vector<glm::vec3>& values) {
        return std::vector<float>(&values[0].x, &values[0].x + 3 * values.size());
    };
    const std::size_t positions = file.accessor(floats(floor.positions), kFloat, "VEC3", 3),
                      normals = file.accessor(floats(floor.normals), kFloat, "VEC3", 3);
    file.json["accessors"][positions]["min"] = {-2, 0, -2};
    file.json["accessors"][positions]["max"] = {2, 0, 2};
    file.json["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
            {"indices", file.accessor(std::vector<std::uint32_t>(&triangles[0].x,
                                                                 &triangles[0].x + 3 * triangles.size()),
                                      kUnsignedInt, "SCALAR", 1)}}}}});
    file.json["nodes"][0]["name"] = "Fine";
    file.json["nodes"].push_back({{"name", "Coarse"}, {"mesh", 1}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1}},
                                                                {{"type", "point"}, {"intensity", 0.2}}};
    for (const int light : {0, 1}) {
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back({{"translation", {light == 0 ? 8 : 0, 1, 0}},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    file.write(folder / "two.glb");
    const Outcome baked = prt({"bake", at("two.glb"), "-o", at("n.glb"), "--rays", "64", "--order", "2",
                               "--fit", "vertex", "--json", at("n.json")});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.out.find("objects with much larger errors: 'Coarse'"), std::string::npos) << baked.out;
    const auto errors = nlohmann::json::parse(std::ifstream(folder / "n.json"))["errors"];
    ASSERT_EQ(errors["objects"].size(), 2u);
    const auto& fine = errors["objects"][0];
    EXPECT_EQ(fine["name"], "Fine");
    EXPECT_LT(fine["lamps"]["relative_l2"], 0.02);
    EXPECT_TRUE(fine["back_sides"]["relative_l2"].is_null());     // one-sided
    EXPECT_GT(errors["objects"][1]["lamps"]["relative_l2"], 0.5); // the middle is brightest, corners far away
}

TEST_F(LampCommands, OnlyLampsHaveNoSkyBudget) {
    GlbFile file = scene_file(SceneBuilder().bowl({0, 0, 0}, 1, 6, 0).build());
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1}}};
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.write(folder / "s.glb");
    bake("n.glb", {});
    const Outcome outcome = prt({"evaluate", at("n.glb"), "--measure", "budget"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("the transfer has no distant light"), std::string::npos) << outcome.err;
}

// White would turn every triangle into a lamp.
TEST_F(LampCommands, WhoseTexturesAreMissingAreDark) {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 1, 6).build());
    const std::array<std::byte, 4> damaged{};
    file.json["textures"] = {{{"source", add_image(file, damaged, "image/webp")}}};
    file.json["materials"] = {{{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "s.glb");
    bake("dark.glb", {"--bad-textures", "ignore"});
    EXPECT_TRUE(lamps_of("dark.glb").empty());
    const Outcome drawn = prt({"render", at("dark.glb"), "-o", at("p.png"), "--size", "32x32", "--device",
                               "cpu", "--bad-textures", "ignore"});
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(prt({"render", at("dark.glb"), "-o", at("p.png"), "--size", "32x32", "--device", "cpu"}).status,
              1);
}

TEST_F(LampCommands, ScaleWithTheirStrengths) {
    ASSERT_EQ(prt({"compress", at("b.glb"), "-o", at("c.glb"), "--bits", "float", "--clusters", "16"}).status,
              0);
    EXPECT_EQ(lamps_of("b.glb"), (std::vector<std::string>{"Lamp.white", "Lamp.red"}));
    EXPECT_EQ(lamps_of("c.glb"), lamps_of("b.glb"));
    folder.file("strengths.json", R"({"Lamp.white": [3, 0, 1], "*": 0})");
    for (const char* model : {"b.glb", "c.glb"}) {
        const VertexArray vertices = lit(model, at("strengths.json"));
        for (std::size_t p = 0; p < vertices.size(); ++p) {
            const glm::vec3 to = glm::vec3(0, kHeight, 0) - vertices.positions[p];
            const float distance = glm::length(to);
            const float white =
                2 * kHeight / (static_cast<float>(std::numbers::pi) * distance * distance * distance);
            EXPECT_LT(glm::distance(glm::vec3(vertices.colors[p]), white * glm::vec3(3, 0, 1)), 0.01f * white)
                << model;
        }
    }
    const VertexArray off = lit("b.glb", "off"), on = lit("b.glb", "on");
    for (std::size_t p = 0; p < off.size(); ++p) {
        EXPECT_EQ(glm::vec3(off.colors[p]), glm::vec3(0));
        EXPECT_GT(on.colors[p].r, on.colors[p].g); // the red one shines, too
    }
}

TEST_F(LampCommands, AreGroupedOrOmitted) {
    bake("g.glb", {"--lamps", "group=all of them=Lamp.*"});
    EXPECT_EQ(lamps_of("g.glb"), std::vector<std::string>{"all of them"});
    bake("n.glb", {"--lamps", "none"});
    EXPECT_TRUE(lamps_of("n.glb").empty());
    const VertexArray together = lit("g.glb", "on"), separate = lit("b.glb", "on");
    for (std::size_t p = 0; p < separate.size(); ++p)
        EXPECT_LT(glm::distance(together.colors[p], separate.colors[p]), 1e-5f);
}

TEST_F(LampCommands, CanBeTheOnlyLight) {
    const Outcome outcome =
        prt({"render", at("b.glb"), "-o", at("p.png"), "--device", "cpu", "--json", at("r.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto report = nlohmann::json::parse(std::ifstream(folder / "r.json"));
    // 0.3 of radiance in the middle, less about it: its mean becomes 0.22.
    EXPECT_NEAR(report["exposure_stops"].get<double>(), 0, 1);
}

/// An older version wrote these lamps, without light of their suns.
TEST_F(LampCommands, SunsOfOlderVersionsAreRejected) {
    GlbFile file = read_glb(folder / "b.glb");
    set_of(file.json, "vertices")["terms"].back()["towards"] = {0, 1, 0};
    file.write(folder / "old.glb");
    const Outcome outcome = prt({"info", at("old.glb")});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("run prt bake again"), std::string::npos) << outcome.err;
}

TEST_F(LampCommands, InvalidLampsAreReportedInOneLine) {
    bake("n.glb", {"--lamps", "none"});
    folder.file("unknown.json", R"({"Lamp.blue": 1})");
    folder.file("negative.json", R"({"Lamp.white": -1})");
    folder.file("word.json", R"({"Lamp.white": "bright"})");
    folder.file("list.json", "[1, 2]");
    folder.file("nan.json", R"({"Lamp.white": NaN})");
    const auto refused = [&](const std::vector<std::string>& arguments, int status, const char* words) {
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, status) << words;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no.glb")) << words;
    };
    const auto strengths = [&](const char* file) {
        return std::vector<std::string>{"relight",    at("b.glb"),        "-o",
                                        at("no.glb"), "--lamp-strengths", at(file)};
    };
    refused(strengths("unknown.json"), 1, "the model has no lamp 'Lamp.blue'; its lamps are: Lamp.white");
    refused(strengths("negative.json"), 1, "the strength of 'Lamp.white'");
    refused(strengths("word.json"), 1, "the strength of 'Lamp.white'");
    refused(strengths("list.json"), 1, "a JSON object with a strength for each lamp");
    refused(strengths("nan.json"), 1, "not valid JSON: the error is at byte");
    refused(strengths("missing.json"), 1, "missing.json");
    refused({"relight", at("n.glb"), "-o", at("no.glb")}, 1, "has no lamps; light it with --lights");
    refused({"bake", at("s.glb"), "-o", at("no.glb"), "--lamps", "group=Lantern"}, 2, "NAME=PATTERN");
    refused({"bake", at("s.glb"), "-o", at("no.glb"), "--lamps", "group=a=Lantern*"}, 1, "'Lantern*'");
    refused({"bake", at("s.glb"), "-o", at("no.glb"), "--lamps", "radius=-1"}, 2, "radius=-1");
    refused({"bake", at("s.glb"), "-o", at("no.glb"), "--lamps", "some"}, 2, "--lamps");
}

} // namespace
} // namespace prt::test
