// Tests files with transfer of a level and lobes of a figure that moves in it.

#include "cli/pipeline/model.h"
#include "pipeline.h"
#include "prt/core/clustered_transfer.h"
#include "prt/core/lobes.h"
#include "prt/core/sh.h"
#include "prt/gltf/levels.h"
#include "prt/load/model.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace prt::test {
namespace {

using Json = nlohmann::ordered_json;
using pipeline::SceneFile;

/// Adds a mesh with a grid of 3 x 3 vertices on the unit square at z = 0, and texture coordinates that start
/// at `u`.
Json& add_square(GlbFile& file, float u) {
    std::vector<float> positions, normals, texcoords;
    for (int i = 0; i < 9; ++i) {
        const float x = static_cast<float>(i % 3) / 2, y = static_cast<float>(i / 3) / 2;
        positions.insert(positions.end(), {x - 0.5f, y, 0});
        normals.insert(normals.end(), {0, 0, 1});
        texcoords.insert(texcoords.end(), {u + 0.2f * x, 0.2f + 0.5f * y});
    }
    std::vector<std::uint16_t> indices;
    for (const int i : {0, 1, 3, 4})
        for (const int corner : {0, 1, 4, 0, 4, 3})
            indices.push_back(static_cast<std::uint16_t>(i + corner));
    const auto uv = file.accessor(texcoords, kFloat, "VEC2", 2),
               position = file.accessor(positions, kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {-0.5, 0, 0};
    file.json["accessors"][position]["max"] = {0.5, 1, 0};
    const Json primitive = {{"attributes",
                             {{"POSITION", position},
                              {"NORMAL", file.accessor(normals, kFloat, "VEC3", 3)},
                              {"TEXCOORD_0", uv},
                              {"TEXCOORD_1", uv}}},
                            {"indices", file.accessor(indices, kUnsignedShort, "SCALAR", 1)},
                            {"material", 0}};
    file.json["meshes"].push_back({{"primitives", Json::array({primitive})}});
    return file.json["meshes"].back()["primitives"][0];
}

/// Returns a floor, two cards that share a mesh, and a bending figure between them.
GlbFile level() {
    GlbFile file;
    add_square(file, 0);
    add_square(file, 0.3f);
    Json& figure = add_square(file, 0.6f);
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (int i = 0; i < 9; ++i) {
        joints.insert(joints.end(), {static_cast<std::uint8_t>(i / 6), 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
    }
    figure["attributes"]["JOINTS_0"] = file.accessor(joints, kUnsignedByte, "VEC4", 4);
    figure["attributes"]["WEIGHTS_0"] = file.accessor(weights, kFloat, "VEC4", 4);
    file.json["materials"] =
        Json::array({{{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
    const float half = 0.70710678f;
    file.json["nodes"] = {
        {{"mesh", 0}, {"rotation", {-half, 0, 0, half}}, {"scale", {4, 4, 4}}, {"translation", {0, 0, 2}}},
        {{"mesh", 1}, {"translation", {-0.8f, 0, -0.5f}}},
        {{"mesh", 1}, {"translation", {0.8f, 0, -0.5f}}},
        {{"mesh", 2}, {"skin", 0}},
        {{"children", {5}}},
        {{"name", "upper"}}};
    file.json["skins"] = Json::array({{{"joints", {4, 5}}}});
    file.json["scenes"] = Json::array({{{"nodes", {0, 1, 2, 3, 4}}}});
    file.json["scene"] = 0;
    const auto times = file.accessor(std::vector<float>{0, 1}, kFloat, "SCALAR", 1),
               rotations = file.accessor(std::vector<float>{0, 0, 0, 1, 0.3826834f, 0, 0, 0.9238795f}, kFloat,
                                         "VEC4", 4);
    file.json["accessors"][times]["min"] = {0};
    file.json["accessors"][times]["max"] = {1};
    file.json["animations"] = Json::array(
        {{{"name", "bend"},
          {"samplers", Json::array({{{"input", times}, {"output", rotations}}})},
          {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 5}, {"path", "rotation"}}}}})}}});
    return file;
}

/// Returns the figure of `level` alone, which lies on its back in the pose of the file, so that its back sees
/// nothing above the horizon, and stands in the animation.
GlbFile lying_figure() {
    GlbFile file = level();
    const float half = 0.70710678f;
    file.json["scenes"][0]["nodes"] = {3, 4};
    file.json["nodes"][4]["rotation"] = {-half, 0, 0, half};
    auto& animation = file.json["animations"][0];
    animation["channels"][0]["target"]["node"] = 4;
    animation["samplers"][0]["output"] =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1}, kFloat, "VEC4", 4);
    return file;
}

/// Adds a coarser level of the figure, as a node outside the scene, and one of the floor.
GlbFile with_levels(GlbFile file) {
    Json nodes = file.json["nodes"];
    for (const int of : {3, 0}) {
        Json& coarse = add_square(file, 0);
        const std::vector<std::uint16_t> corners{0, 2, 8, 0, 8, 6};
        coarse["indices"] = file.accessor(corners, kUnsignedShort, "SCALAR", 1);
        Json& attributes = coarse["attributes"];
        const std::size_t mesh = nodes[static_cast<std::size_t>(of)]["mesh"];
        for (const char* name : {"JOINTS_0", "WEIGHTS_0"})
            if (const Json& fine = file.json["meshes"][mesh]["primitives"][0]["attributes"];
                fine.contains(name))
                attributes[name] = fine[name];
        Json node = nodes[static_cast<std::size_t>(of)];
        node["mesh"] = file.json["meshes"].size() - 1;
        nodes[static_cast<std::size_t>(of)]["extensions"]["MSFT_lod"] = {{"ids", {nodes.size()}}};
        nodes.push_back(std::move(node));
    }
    file.json["nodes"] = std::move(nodes);
    file.json["extensionsUsed"] = {"MSFT_lod"};
    return file;
}

/// Settings of a compression that takes little time.
const std::vector<std::string> kSmall = {"--preset", "custom", "--clusters", "2", "--components", "3"};

class FigureInLevel : public Pipeline {
protected:
    void SetUp() override { level().write(folder / "level.glb"); }

    Outcome make(const char* command, const char* from, const char* to,
                 const std::vector<std::string>& options) {
        std::vector<std::string> all = {command, at(from), "-o", at(to)};
        all.insert(all.end(), options.begin(), options.end());
        Outcome outcome = prt(all);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome;
    }
    /// Adds those of `defaults` that `options` do not contain.
    static void complete(std::vector<std::string>& options,
                         std::initializer_list<std::pair<const char*, const char*>> defaults) {
        for (const auto& [name, value] : defaults)
            if (std::ranges::find(options, name) == options.end())
                options.insert(options.end(), {name, value});
    }
    Outcome bake(const char* from, const char* to, std::vector<std::string> options = {}) {
        const bool texels = std::ranges::find(options, "--texels") != options.end();
        complete(options,
                 {{"--back-sides", "shared"}, {"--order", "3"}, {"--rays", "32"}, {"--bounces", "1"}});
        if (!texels)
            options.insert(options.end(), {"--fit", "vertex"});
        return make("bake", from, to, options);
    }
    Outcome lobes(const char* from, const char* to, std::vector<std::string> options = {}) {
        complete(options, {{"--back-sides", "shared"}, {"--order", "3"}, {"--rays", "32"}});
        options.insert(options.end(), {"--poses", "1", "--poses", "frames=0", "--lobes", "1"});
        return make("lobes", from, to, options);
    }
    SceneFile open(const char* name) const { return pipeline::load_scene_file(folder / name); }

    /// Draws a model to pixels.
    std::vector<glm::vec3> picture(const char* model, const char* device) {
        const Outcome drawn = prt({"render", at(model), "--lights", at("sky.exr"), "-o", at("p.exr"),
                                   "--size", "64x32", "--camera", "0.5,1.5,4", "--look-at", "0,0.4,0",
                                   "--no-background", "--suns", "0", "--samples", "1", "--device", device});
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        return load_environment(folder / "p.exr").environment.image.pixels;
    }
    /// Expects that each pixel of `both` is that of `level` or of `figure`, and that both occur.
    void expect_joined(const char* both, const char* level, const char* figure, const char* device) {
        const auto pixels = picture(both, device), static_pixels = picture(level, device),
                   moving = picture(figure, device);
        std::size_t of_level = 0, of_figure = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const bool a = glm::distance(pixels[i], static_pixels[i]) < 1e-4f,
                       b = glm::distance(pixels[i], moving[i]) < 1e-4f;
            EXPECT_TRUE(a || b) << both << ", pixel " << i << " " << device;
            of_level += a && !b;
            of_figure += b && !a;
        }
        EXPECT_GT(of_level, 20u) << both;
        EXPECT_GT(of_figure, 5u) << both;
    }
};

/// Returns which receivers have lobes.
std::vector<bool> figure_of(const Scene& scene) {
    std::vector<bool> figure;
    for (const VertexArray& vertices : scene.vertex_arrays)
        figure.insert(figure.end(), vertices.size(), vertices.lobes);
    return figure;
}

/// Returns the words of the receivers with lobes.
std::vector<LobeWord> words_of_figure(const SceneFile& file) {
    const std::vector<bool> figure = figure_of(file.scene);
    std::vector<LobeWord> words; // one lobe per receiver
    for (std::size_t p = 0; p < figure.size(); ++p)
        if (figure[p])
            words.push_back(file.lobes->model.words[p]);
    return words;
}

void expect_same_lobes(const SceneFile& a, const SceneFile& b) {
    ASSERT_TRUE(a.lobes && b.lobes);
    EXPECT_EQ(a.lobes->model.words, b.lobes->model.words);
    EXPECT_EQ(a.lobes->model.profiles, b.lobes->model.profiles);
    EXPECT_EQ(figure_of(a.scene), figure_of(b.scene));
}

/// Expects the same raw transfer at receivers without lobes, and none at the others.
void expect_same_transfer(const SceneFile& both, const SceneFile& level) {
    ASSERT_TRUE(both.baked && level.baked);
    const std::vector<bool> figure = figure_of(both.scene);
    ASSERT_EQ(figure.size(), level.scene.receivers());
    EXPECT_EQ(std::ranges::count(figure, true), 9);
    for (std::size_t p = 0; p < figure.size(); ++p) {
        const auto here = both.baked->transfer.vector(p), expected = level.baked->transfer.vector(p);
        if (figure[p])
            EXPECT_TRUE(std::ranges::all_of(here, [](float value) { return value == 0; })) << p;
        else
            EXPECT_TRUE(std::ranges::equal(here, expected)) << p;
    }
}

TEST_F(FigureInLevel, KeepsTransferAndLobesInBothOrders) {
    for (const std::vector<std::string>& options : {std::vector<std::string>{"--instances", "own"},
                                                    {"--instances", "shared", "--instances", "error=50"}}) {
        bake("level.glb", "baked.glb", options);
        lobes("baked.glb", "one.glb");
        lobes("level.glb", "figure.glb");
        const Outcome outcome = bake("figure.glb", "other.glb", options);
        EXPECT_NE(outcome.err.find("9 vertices keep their lobes"), std::string::npos) << outcome.err;
        const SceneFile baked = open("baked.glb"), one = open("one.glb"), other = open("other.glb");
        EXPECT_EQ(one.instanced.has_value(), options[1] == "shared");
        EXPECT_EQ(other.instanced.has_value(), options[1] == "shared");
        expect_same_transfer(one, baked);
        expect_same_transfer(other, baked);
        expect_same_lobes(one, other);
        expect_same_lobes(one, open("figure.glb"));
        EXPECT_EQ(validator_errors(folder / "one.glb"), 0);
        EXPECT_EQ(validator_errors(folder / "other.glb"), 0);
    }
}

/// In free space, the transfer of both sides is the clamped cosine of their normals.
TEST_F(FigureInLevel, BacksHaveTheirOwnLobes) {
    GlbFile alone = level();
    alone.json["scenes"][0]["nodes"] = {3, 4};
    alone.json["animations"][0]["channels"][0]["target"]["node"] = 0; // draws nothing
    alone.write(folder / "alone.glb");
    const Outcome outcome = lobes("alone.glb", "both.glb", {"--back-sides", "auto", "--rays", "1024"});
    EXPECT_NE(outcome.err.find("back sides of 8 double-sided triangles; 9 vertices were added"),
              std::string::npos)
        << outcome.err;
    const SceneFile both = open("both.glb");
    ASSERT_TRUE(both.lobes);
    std::size_t backs = 0;
    for (const VertexArray& vertices : both.scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            std::array<Lobe, 1> lobe;
            both.lobes->model.decode(vertices.first_receiver + v, lobe);
            std::array<float, 9> transfer{};
            std::array<double, 9> expected;
            lobe_transfer(lobe, 3, transfer);
            clamped_cosine_lobe(3, glm::dvec3(vertices.normals[v]), expected);
            for (std::size_t i = 0; i < 9; ++i) // noise of 1024 rays, and bytes
                EXPECT_NEAR(transfer[i], expected[i], 0.02) << v << " " << i;
            backs += vertices.normals[v].z < 0;
        }
    EXPECT_EQ(backs, 9u);
    EXPECT_EQ(both.scene.triangles(), 16u);
    EXPECT_EQ(validator_errors(folder / "both.glb"), 0);
}

TEST_F(FigureInLevel, BacksAreLitInAnyPose) {
    lying_figure().write(folder / "lying.glb");
    const Outcome baked = bake("lying.glb", "baked.glb", {"--back-sides", "auto"});
    EXPECT_EQ(baked.err.find("back sides of"), std::string::npos) << baked.err; // dark in this pose
    const Outcome outcome = lobes("lying.glb", "both.glb", {"--back-sides", "auto"});
    EXPECT_NE(outcome.err.find("back sides of 8 double-sided triangles; 9 vertices were added"),
              std::string::npos)
        << outcome.err;
}

TEST_F(FigureInLevel, BacksChangeNothingElse) {
    for (const std::vector<std::string>& options : {std::vector<std::string>{"--instances", "own"},
                                                    {"--instances", "shared", "--instances", "error=50"},
                                                    {"--texels", "16"}}) {
        bake("level.glb", "baked.glb", options);
        const Outcome outcome = lobes("baked.glb", "both.glb", {"--back-sides", "auto"});
        EXPECT_NE(outcome.err.find("back sides of 8 double-sided triangles; 9 vertices were added"),
                  std::string::npos)
            << outcome.err;
        const SceneFile baked = open("baked.glb"), both = open("both.glb");
        EXPECT_EQ(both.instanced.has_value(), options[1] == "shared");
        ASSERT_TRUE(both.baked && both.lobes);
        EXPECT_EQ(words_of_figure(both).size(), 18u);
        const bool texels = options[0] == "--texels";
        const std::size_t same = texels ? baked.baked->transfer.receivers() : baked.scene.receivers() - 9;
        for (std::size_t p = 0; p < same; ++p) {
            EXPECT_TRUE(std::ranges::equal(both.baked->transfer.vector(p), baked.baked->transfer.vector(p)))
                << p;
        }
        EXPECT_EQ(both.scene.receivers(), baked.scene.receivers() + 9);
        EXPECT_EQ(validator_errors(folder / "both.glb"), 0);
        lobes("both.glb", "again.glb", {"--back-sides", "auto"}); // both sides have vertices already
        expect_same_lobes(both, open("again.glb"));
    }
}

/// Levels of the figure have lobes, also with separate backs, and those of the floor transfer.
TEST_F(FigureInLevel, HasLobesInCoarserLevels) {
    with_levels(level()).write(folder / "level.glb");
    for (const auto& [mode, sides] :
         {std::pair("carry", "auto"), std::pair("own", "shared"), std::pair("ignore", "auto")}) {
        const bool ignored = std::string(mode) == "ignore";
        const std::size_t vertices = std::string(sides) == "auto" ? 9 + 4 : 9; // 4 are used
        lobes("level.glb", "figure.glb", {"--levels", mode, "--back-sides", sides});
        bake("figure.glb", "both.glb", {"--json", at("bake.json")});
        EXPECT_EQ(read_json(folder / "bake.json")["levels"]["nodes"], ignored ? 2 : 1);
        make("compress", "both.glb", "small.glb", kSmall);
        for (const char* name : {"figure.glb", "both.glb", "small.glb"}) {
            SCOPED_TRACE(std::string(name) + " " + mode + " " + sides);
            const GltfDocument document = load_gltf(folder / name);
            const LeveledScene levels = extract_levels(document);
            ASSERT_EQ(levels.nodes.size(), 2u);
            const std::optional<StoredLobes> stored = read_lobes(document, levels.scene);
            ASSERT_TRUE(stored);
            std::size_t figure = 0;
            for (const VertexArray& array : levels.scene.vertex_arrays)
                for (std::size_t v = array.first_receiver; v < array.first_receiver + array.size(); ++v) {
                    EXPECT_EQ(stored->model.words[v] != LobeWord{}, array.lobes) << v;
                    figure += v >= levels.finest_receivers && array.lobes;
                }
            EXPECT_EQ(figure, ignored ? 0u : vertices);
            EXPECT_EQ(levels_have_transfer(document, levels), std::string(name) != "figure.glb");
            const Model loaded = load_model(folder / name);
            ASSERT_TRUE(loaded.lobes);
            EXPECT_EQ(loaded.lobes->model.words,
                      open(name).lobes->model.words); // level 0 only
        }
        EXPECT_EQ(validator_errors(folder / "small.glb"), 0);
        EXPECT_EQ(prt({"evaluate", at("both.glb"), at("small.glb")}).status, 0);
        const Outcome info = prt({"info", at("figure.glb")});
        EXPECT_EQ(info.out.find("without transfer, with lobes") == std::string::npos, ignored) << info.out;
    }
}

/// The floor of the high-poly model blocks the light of a figure without a floor, as in its own file.
TEST_F(FigureInLevel, IsMeasuredOnAHighPolyModel) {
    GlbFile alone = level();
    alone.json["scenes"][0]["nodes"] = {3, 4};
    alone.write(folder / "alone.glb");
    const Outcome refused =
        prt({"lobes", at("alone.glb"), "-o", at("x.glb"), "--high-poly", at("level.glb")});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("has no node with the name of joint node 4 ''"), std::string::npos)
        << refused.err;
    EXPECT_EQ(prt({"lobes", at("alone.glb"), "-o", at("x.glb"), "--high-poly", "distance=1"}).status, 1);
    alone.json["nodes"][4]["name"] = "lower";
    alone.write(folder / "alone.glb");
    GlbFile detailed = level();
    detailed.json["nodes"][4]["name"] = "lower";
    detailed.write(folder / "level.glb");
    lobes("alone.glb", "measured.glb", {"--high-poly", at("level.glb"), "--rays", "256"});
    lobes("alone.glb", "free.glb", {"--rays", "256"});
    lobes("level.glb", "figure.glb", {"--rays", "256"});
    const auto transfer = [&](const char* name) { // of the figure, which comes last
        const SceneFile file = open(name);
        const LobeModel& model = file.lobes->model;
        std::vector<float> result(9 * std::size_t{9});
        for (std::size_t v = 0; v < 9; ++v) {
            std::array<Lobe, 1> lobe;
            model.decode(model.vertices() - 9 + v, lobe);
            lobe_transfer(lobe, 3, std::span(result).subspan(9 * v, 9));
        }
        return result;
    };
    const std::vector<float> expected = transfer("figure.glb");
    const auto largest = [&](const std::vector<float>& other) {
        float difference = 0;
        for (std::size_t i = 0; i < other.size(); ++i)
            difference = std::max(difference, std::abs(other[i] - expected[i]));
        return difference;
    };
    EXPECT_LT(largest(transfer("measured.glb")), 0.05f); // rays at edges, and bytes
    EXPECT_GT(largest(transfer("free.glb")), 0.15f);
}

/// If all vertices of level 0 have lobes, readers reject transfer, also that of levels that do not move.
TEST_F(FigureInLevel, LeavesNoTransferOfLevelsAlone) {
    GlbFile alone = with_levels(level());
    alone.json["scenes"][0]["nodes"] = {3, 4};
    for (const char* name : {"JOINTS_0", "WEIGHTS_0"})
        alone.json["meshes"][3]["primitives"][0]["attributes"].erase(name);
    alone.json["nodes"][6].erase("skin");
    alone.write(folder / "alone.glb");
    bake("alone.glb", "baked.glb");
    make("compress", "baked.glb", "small.glb", kSmall);
    lobes("small.glb", "lit.glb");
    EXPECT_TRUE(open("lit.glb").lobes);
    EXPECT_FALSE(open("lit.glb").record());
}

TEST_F(FigureInLevel, IsNotRefinedWithItsLevel) {
    lobes("level.glb", "figure.glb");
    make("bake", "figure.glb", "both.glb",
         {"--order", "3", "--rays", "64", "--refine", "0.03,vertices=200", "--back-sides", "shared"});
    const SceneFile figure = open("figure.glb"), both = open("both.glb");
    ASSERT_TRUE(both.lobes && both.baked);
    EXPECT_EQ(words_of_figure(both), words_of_figure(figure));
    EXPECT_EQ(words_of_figure(both).size(), 9u);
    EXPECT_GT(both.scene.receivers(), figure.scene.receivers());
    EXPECT_EQ(validator_errors(folder / "both.glb"), 0);
}

TEST_F(FigureInLevel, DamagedLobesAreRejectedByABake) {
    lobes("level.glb", "figure.glb");
    const auto refusal = [&](auto&& change) {
        GlbFile damaged = read_glb(folder / "figure.glb");
        change(damaged.json);
        damaged.write(folder / "damaged.glb");
        const Outcome outcome =
            prt({"bake", at("damaged.glb"), "-o", at("x.glb"), "--order", "3", "--rays", "8"});
        EXPECT_EQ(outcome.status, 1);
        EXPECT_FALSE(std::filesystem::exists(folder / "x.glb"));
        return outcome.err;
    };
    const std::string version =
        refusal([](auto& json) { json["extensions"]["PRTKIT_lobes"]["version"] = 9; });
    EXPECT_NE(version.find("PRTKIT_lobes"), std::string::npos) << version;
    refusal([](auto& json) {
        auto& attributes = json["meshes"][2]["primitives"][0]["attributes"];
        attributes["_PRT_LOBE_0"] = attributes["POSITION"];
    });
}

TEST_F(FigureInLevel, IsCompressedWithoutChangingTheLobes) {
    for (const std::vector<std::string>& options : {std::vector<std::string>{},
                                                    {"--instances", "shared", "--instances", "error=50"},
                                                    {"--texels", "16"}}) {
        const bool texels = !options.empty() && options[0] == "--texels";
        bake("level.glb", "baked.glb", options);
        lobes("baked.glb", "both.glb");
        make("compress", "baked.glb", "small.glb", kSmall);
        lobes("small.glb", "one.glb");
        std::vector<std::string> meshopt = kSmall;
        meshopt.push_back("--meshopt");
        make("compress", "both.glb", "other.glb", meshopt);
        const SceneFile small = open("small.glb"), one = open("one.glb"), other = open("other.glb");
        expect_same_lobes(one, other);
        const auto transfer = [&](const SceneFile& file) {
            return file.compressed ? decode(file.compressed->transfer) : file.baked->transfer;
        };
        const Transfer before = transfer(small), after = transfer(one);
        const std::vector<bool> figure = figure_of(one.scene);
        for (std::size_t p = 0; p < before.receivers(); ++p)
            if (texels || !figure[p]) {
                EXPECT_TRUE(std::ranges::equal(before.vector(p), after.vector(p))) << p;
            }
        EXPECT_EQ(prt({"evaluate", at("both.glb"), at("other.glb")}).status, 0);
        const Model loaded = load_model(folder / "other.glb");
        ASSERT_TRUE(loaded.lobes);
        EXPECT_TRUE(texels ? loaded.lightmap.has_value() : loaded.vertices.has_value());
        for (const VertexArray& vertices : loaded.scene.vertex_arrays)
            for (std::size_t v = 0; v < vertices.size(); ++v)
                EXPECT_EQ(loaded.lobes->model.words[vertices.first_receiver + v] != LobeWord{},
                          vertices.lobes);
        const Outcome info = prt({"info", at("other.glb")});
        EXPECT_NE(info.out.find("9 vertices"), std::string::npos) << info.out;
        EXPECT_NE(info.out.find("clustered PCA"), std::string::npos) << info.out;
        EXPECT_EQ(prt({"shader", at("other.glb"), "-o", at("v.glsl")}).status, 0);
        EXPECT_EQ(prt({"shader", at("other.glb"), "-o", at("l.glsl"), "--stage", "lobes"}).status, 0);
        EXPECT_EQ(validator_errors(folder / "other.glb"), 0);
    }
}

TEST_F(FigureInLevel, IsLitAsInTwoFiles) {
    std::vector<glm::vec3> sky(32, glm::vec3(0.1f));
    std::fill_n(sky.begin(), 12, glm::vec3(1, 0.8f, 0.6f));
    write_exr(folder / "sky.exr", {8, 4, sky});
    lobes("level.glb", "figure.glb");
    for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--texels", "16"}}) {
        bake("figure.glb", "both.glb", options);
        bake("level.glb", "baked.glb", options);
        make("compress", "baked.glb", "small_level.glb", kSmall);
        lobes("small_level.glb", "small.glb");
        expect_joined("both.glb", "baked.glb", "figure.glb", "cpu");
        expect_joined("small.glb", "small_level.glb", "figure.glb", "gpu");
    }
}

TEST_F(FigureInLevel, GetsColorsOfBoth) {
    bake("level.glb", "baked.glb");
    lobes("baked.glb", "both.glb");
    write_exr(folder / "sky.exr", {8, 4, std::vector<glm::vec3>(32, glm::vec3(1))});
    const auto colors = [&](const char* model) {
        make("relight", model, "colors.glb", {"--lights", at("sky.exr")});
        std::vector<glm::vec3> result;
        const GltfDocument document = load_gltf(folder / "colors.glb");
        EXPECT_FALSE(has_lobes(document));
        for (const VertexArray& vertices : extract_scene(document).vertex_arrays)
            for (const glm::vec4& color : vertices.colors)
                result.emplace_back(color);
        return result;
    };
    const auto both = colors("both.glb"), baked = colors("baked.glb");
    const std::vector<bool> figure = figure_of(open("both.glb").scene);
    ASSERT_EQ(both.size(), figure.size());
    for (std::size_t p = 0; p < figure.size(); ++p)
        EXPECT_LT(glm::distance(both[p], baked[p]), figure[p] ? 0.3f : 1e-6f) << p; // noise, few bands
}

TEST_F(FigureInLevel, LosesItsLobesOnlyIfRequested) {
    lobes("level.glb", "figure.glb");
    bake("level.glb", "baked.glb");
    bake("figure.glb", "again.glb", {"--stored-lobes", "remove"});
    const SceneFile again = open("again.glb");
    EXPECT_FALSE(again.lobes);
    EXPECT_EQ(again.baked->transfer.vectors, open("baked.glb").baked->transfer.vectors);
    GlbFile alone = level();
    alone.json["scenes"][0]["nodes"] = {3, 4};
    alone.write(folder / "alone.glb");
    lobes("alone.glb", "alone.glb.glb");
    const Outcome nothing = prt({"bake", at("alone.glb.glb"), "-o", at("x.glb"), "--rays", "8"});
    EXPECT_EQ(nothing.status, 1);
    EXPECT_NE(nothing.err.find("all vertices have lobes"), std::string::npos) << nothing.err;
}

} // namespace
} // namespace prt::test
