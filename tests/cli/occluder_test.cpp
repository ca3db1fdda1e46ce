// Tests prt ao --occluders: occlusion by moving parts, and rejected input.

#include "pipeline.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace prt::test {
namespace {

class OccluderCommand : public Pipeline {
protected:
    void SetUp() override { copy_examples(folder.path(), {"figure"}); }
    Outcome ao(const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"ao", at("figure.glb"), "-o", at("out.glb"), "--occluders"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
};

TEST_F(OccluderCommand, WritesVolumesAndReportsTheirError) {
    const Outcome outcome = ao({"--rays", "32", "--json", at("ao.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(validator_errors(folder / "out.glb"), 0);
    const nlohmann::json figures = read_json(folder / "ao.json");
    EXPECT_EQ(read_occluders(load_gltf(folder / "out.glb")).size(), figures["objects"]);
    EXPECT_GT(figures["floor_mean_blocked"], figures["floor_mean_error"]);
    EXPECT_LT(figures["mean_error"], 0.05);
    // Later commands keep the occluders.
    ASSERT_EQ(prt({"bake", at("out.glb"), "-o", at("baked.glb"), "--rays", "8", "--order", "2"}).status, 0);
    EXPECT_EQ(read_occluders(load_gltf(folder / "baked.glb")).size(), figures["objects"]);
    const Outcome info = prt({"info", at("baked.glb")});
    EXPECT_NE(info.out.find("have an occlusion volume"), std::string::npos) << info.out;
}

TEST_F(OccluderCommand, RejectsSurfaceOptions) {
    for (const auto& options : std::vector<std::vector<std::string>>{{"--texels", "64"},
                                                                     {"--attribute", "_AO"},
                                                                     {"--bent-normals"},
                                                                     {"--fit", "surface"},
                                                                     {"--enclosed", "keep"}})
        EXPECT_EQ(ao(options).status, 2) << options[0];
    const Outcome outcome = ao({"--max-distance", "2"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("does not support --falloff"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
}

/// Writes spheres at x = -2 and x = 2: of radius `scale` / 5 below a node 'ball', and of radius 1/5 at a node
/// `second`.
void write_spheres(const std::filesystem::path& path, double scale, const char* second) {
    GlbFile file = scene_file(SceneBuilder().sphere({0, 0, 0}, 0.2f, 6).build());
    file.json["nodes"] = {{{"name", "ball"}, {"translation", {-2, 0, 0}}, {"children", {1}}},
                          {{"mesh", 0}, {"scale", {scale, scale, scale}}},
                          {{"name", second}, {"translation", {2, 0, 0}}, {"mesh", 0}}};
    file.json["scenes"][0]["nodes"] = {0, 2};
    file.write(path);
}

/// Objects with and without a counterpart block light as those of a file with the same triangles.
TEST_F(OccluderCommand, TracesAHighPolyModel) {
    write_spheres(folder / "low.glb", 1, "stone");
    write_spheres(folder / "high.glb", 3, "unknown");
    write_spheres(folder / "both.glb", 3, "stone");
    const auto bake = [&](const char* scene, const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {
            "ao", at(scene), "-o", at("out.glb"), "--occluders", "--json", at("ao.json"), "--rays", "6"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.err;
    };
    bake("both.glb", {});
    const std::vector<NodeOccluder> expected = read_occluders(load_gltf(folder / "out.glb"));
    const nlohmann::json floor = read_json(folder / "ao.json");
    const std::string notices = bake("low.glb", {"--high-poly", at("high.glb")});
    EXPECT_NE(notices.find("which keep their own: stone"), std::string::npos) << notices;
    EXPECT_NE(notices.find("triangles have no object with the name of their node"), std::string::npos);
    const std::vector<NodeOccluder> found = read_occluders(load_gltf(folder / "out.glb"));
    ASSERT_EQ(expected.size(), 2u);
    ASSERT_EQ(found.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(found[i].node, expected[i].node);
        EXPECT_NEAR(found[i].volume.low.x, expected[i].volume.low.x, 1e-5f);
        EXPECT_NEAR(found[i].volume.reach, expected[i].volume.reach, 1e-2f);
        for (std::size_t t = 0; t < expected[i].volume.texels.size(); ++t)
            for (std::size_t c = 0; c < 4; ++c) // of 127
                EXPECT_NEAR(found[i].volume.texels[t][c], expected[i].volume.texels[t][c], 2) << t;
    }
    const nlohmann::json figures = read_json(folder / "ao.json");
    for (const char* of_floor : {"floor_mean_blocked", "floor_mean_error"})
        EXPECT_NEAR(figures[of_floor], floor[of_floor], 1e-3) << of_floor;
}

} // namespace
} // namespace prt::test
