// Tests levels of detail through the program: baked, compressed, reported, evaluated and drawn; and rejected
// input.

#include "pipeline.h"
#include "prt/gltf/levels.h"
#include "support/level_file.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace prt::test {
namespace levels_of_files {

class LevelsOfDetail : public Pipeline {
protected:
    /// A ball with a dent, of some 2 000 triangles.
    GlbFile ball(bool under_a_roof = false) const {
        const auto dented = [](const glm::vec3& p) { return p.y > 0.5f ? glm::vec3(p.x, 1 - p.y, p.z) : p; };
        SceneBuilder builder = SceneBuilder().sphere({0, 0, 0}, 1, 24).transform(dented);
        if (under_a_roof)
            builder.quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
        GlbFile file = scene_file(builder.build());
        file.json["nodes"][0]["name"] = "ball";
        return file;
    }
    void write(const GlbFile& file, const char* name) const { file.write(folder / name); }
    Outcome bake(const char* scene, const char* output, const std::vector<std::string>& options = {}) const {
        std::vector<std::string> arguments = {"bake",   at(scene), "-o",      at(output),
                                              "--rays", "64",      "--order", "3"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
    std::vector<float> transfer_of(const char* name) const {
        const GltfDocument document = load_gltf(folder / name);
        return read_transfer(document, extract_scene(document))->transfer.vectors;
    }
    void expect_refused(const GlbFile& file, const std::string& words,
                        const std::vector<std::string>& options = {}) const {
        write(file, "bad.glb");
        const Outcome outcome = bake("bad.glb", "no.glb", options);
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no.glb"));
    }
};

/// Uniform light of three bands.
void write_light(const std::filesystem::path& path) {
    const std::vector<double> uniform = {3.5449077, 0, 0, 0, 0, 0, 0, 0, 0};
    std::ofstream(path) << nlohmann::json{
        {"prtkit_light", 1},
        {"order", 3},
        {"coefficients", {{"red", uniform}, {"green", uniform}, {"blue", uniform}}}};
}

constexpr float kShares[] = {0.5f, 0.1f};

TEST_F(LevelsOfDetail, WorkInAllCommands) {
    write(ball(), "ball.glb");
    write(with_levels(ball(), kShares), "levels.glb");
    write(with_levels(ball(), kShares, LevelsBy::names), "names.glb");
    ASSERT_EQ(bake("ball.glb", "alone.glb").status, 0);
    ASSERT_EQ(bake("levels.glb", "baked.glb", {"--json", at("bake.json")}).status, 0);
    ASSERT_EQ(bake("names.glb", "named.glb").status, 0);
    EXPECT_EQ(transfer_of("baked.glb"), transfer_of("alone.glb")); // bit by bit
    EXPECT_EQ(transfer_of("named.glb"), transfer_of("alone.glb"));
    const nlohmann::json levels = read_json(folder / "bake.json")["levels"];
    EXPECT_EQ(levels["mode"], "carry");
    ASSERT_EQ(levels["by_level"].size(), 2u);
    EXPECT_EQ(levels["all"][1]["level_0"], "node 0 'ball'");
    EXPECT_GT(levels["by_level"][0]["relative_l2"], 0);
    EXPECT_LT(levels["by_level"][0]["relative_l2"], levels["by_level"][1]["relative_l2"]);
    EXPECT_LT(levels["by_level"][1]["relative_l2"], 0.2);
    EXPECT_EQ(validator_errors(folder / "baked.glb"), 0);

    ASSERT_EQ(
        prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--json", at("compress.json")}).status, 0);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);
    const nlohmann::json compressed = read_json(folder / "compress.json")["levels"];
    ASSERT_EQ(compressed.size(), 2u);
    EXPECT_LT(compressed[1]["relative_l2"], 0.1);
    ASSERT_EQ(prt({"compress", at("baked.glb"), "-o", at("reordered.glb"), "--reorder", "--meshopt"}).status,
              0);
    EXPECT_EQ(prt({"evaluate", at("baked.glb"), at("reordered.glb")}).status, 0);
    ASSERT_EQ(prt({"evaluate", at("baked.glb"), at("shipped.glb"), "--json", at("errors.json")}).status, 0);
    const nlohmann::json errors = read_json(folder / "errors.json")["levels"];
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_NEAR(errors[0]["baked_relative_l2"], levels["by_level"][0]["relative_l2"],
                1e-4); // rounding of float16 at most
    EXPECT_LT(errors[0]["shipped_relative_l2"], 0.1);
    EXPECT_LT(errors[1]["lit_rms"], 0.2);
    ASSERT_EQ(prt({"info", at("shipped.glb"), "--json", at("info.json")}).status, 0);
    EXPECT_EQ(read_json(folder / "info.json")["levels"]["transfer"], true);
    EXPECT_EQ(prt({"shader", at("shipped.glb"), "-o", at("shader")}).status, 0);
}

TEST_F(LevelsOfDetail, AreDrawnAndLitLikeLevel0) {
    write(with_levels(ball(), kShares), "levels.glb");
    write_light(folder / "sky.json");
    ASSERT_EQ(bake("levels.glb", "baked.glb").status, 0);
    ASSERT_EQ(
        prt({"compress", at("baked.glb"), "-o", at("shipped.glb"), "--fallback", at("sky.json")}).status, 0);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);
    for (const char* name : {"baked.glb", "shipped.glb"}) {
        EXPECT_EQ(prt({"render", at(name), "--lights", at("sky.json"), "-o", at("a.png"), "--size", "32x24",
                       "--device", "cpu"})
                      .status,
                  0);
        EXPECT_EQ(prt({"relight", at(name), "--lights", at("sky.json"), "-o", at("lit.glb")}).status, 0);
    }
    const GltfDocument document = load_gltf(folder / "shipped.glb");
    const LeveledScene levels = extract_levels(document);
    EXPECT_EQ(read_clustered(document, levels.scene)->transfer.receivers.size(), levels.scene.receivers());
    EXPECT_EQ(read_clustered(document, extract_scene(document))->transfer.receivers.size(),
              levels.finest_receivers);
    EXPECT_GT(levels.scene.receivers(), levels.finest_receivers);
}

TEST_F(LevelsOfDetail, AreBakedOnRequest) {
    write(with_levels(ball(), kShares), "levels.glb");
    ASSERT_EQ(bake("levels.glb", "own.glb", {"--levels", "own", "--json", at("own.json")}).status, 0);
    ASSERT_EQ(bake("levels.glb", "carry.glb", {"--levels", "carry"}).status, 0);
    ASSERT_EQ(bake("levels.glb", "none.glb", {"--levels", "ignore", "--json", at("none.json")}).status, 0);
    EXPECT_EQ(transfer_of("own.glb"), transfer_of("carry.glb"));
    EXPECT_EQ(read_json(folder / "own.json")["levels"]["mode"], "own");
    EXPECT_EQ(read_json(folder / "none.json")["levels"]["mode"], "ignore");
    for (const char* name : {"own.glb", "carry.glb", "none.glb"}) {
        const GltfDocument document = load_gltf(folder / name);
        EXPECT_EQ(levels_have_transfer(document, extract_levels(document)), std::string(name) != "none.glb");
    }
    ASSERT_EQ(prt({"compress", at("none.glb"), "-o", at("shipped.glb")}).status, 0);
    EXPECT_EQ(prt({"evaluate", at("carry.glb"), at("shipped.glb")}).status, 0);
    EXPECT_EQ(bake("levels.glb", "fine.glb", {"--refine", "0.3"}).status, 0);
    write(ball(true), "under_a_roof.glb");
    const Outcome detailed =
        bake("levels.glb", "detailed.glb",
             {"--levels", "own", "--high-poly", at("under_a_roof.glb"), "--json", at("detailed.json")});
    ASSERT_EQ(detailed.status, 0) << detailed.err;
    EXPECT_LT(read_json(folder / "detailed.json")["levels"]["by_level"][0]["relative_l2"],
              0.2); // is darker, too
    EXPECT_NE(transfer_of("detailed.glb"), transfer_of("own.glb"));
    const Outcome texels = bake("levels.glb", "texels.glb", {"--texels", "4/m", "--texels", "unwrap"});
    EXPECT_EQ(texels.status, 0) << texels.err;
    EXPECT_NE(texels.err.find("get no lightmap"), std::string::npos) << texels.err;
}

TEST_F(LevelsOfDetail, MismatchesAreRejected) {
    GlbFile file = with_levels(ball(), kShares);
    GlbFile far = file;
    far.json["nodes"][2]["translation"] = {5, 0, 0};
    expect_refused(far, "node 2 'ball_LOD2', level 2 of node 0 'ball', is");
    GlbFile large = file;
    large.json["nodes"][1]["scale"] = {9, 9, 9};
    expect_refused(large, "level 1 of node 0 'ball'");
    GlbFile missing = file;
    missing.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {1, 9};
    expect_refused(missing, "refers to node 9, which does not exist");
    expect_refused(file, "no transfer can be shared", {"--instances", "shared"});
    write(far, "far.glb");
    EXPECT_EQ(bake("far.glb", "ignored.glb", {"--levels", "ignore"}).status, 0);
    GlbFile empty = file;
    empty.json["nodes"][1].erase("mesh");
    write(empty, "empty.glb");
    const Outcome told = bake("empty.glb", "some.glb");
    EXPECT_EQ(told.status, 0);
    EXPECT_NE(told.err.find("node 1 'ball_LOD1', level 1 of node 0 'ball', has no triangles"),
              std::string::npos)
        << told.err;
}

} // namespace levels_of_files
} // namespace prt::test
