// Tests prt ao --occluders: occlusion by moving parts, and rejected input.

#include "pipeline.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"

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

} // namespace
} // namespace prt::test
