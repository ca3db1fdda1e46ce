// Tests transfer terms through the pipeline, from the bake to the shipped file.

#include "program.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <utility>

namespace prt::test {
namespace {

class TransferTerms : public testing::Test {
protected:
    void SetUp() override {
        scene_file(SceneBuilder().floor({0, 0, 0}, 1, 6).sphere({0, 0.6f, 0}, 0.4f, 8).build())
            .write(folder / "s.glb");
        prt_once("b.glb", {"bake", at("s.glb"), "--rays", "64", "--order", "3", "--bounces", "1"},
                 folder / "b.glb");
    }
    std::string at(const char* name) const { return (folder / name).string(); }
    nlohmann::json figures_of(std::vector<std::string> command) const {
        command.insert(command.end(), {"--json", at("r.json")});
        const Outcome outcome = prt(command);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return nlohmann::json::parse(std::ifstream(folder / "r.json"));
    }

    TemporaryFolder folder;
    const nlohmann::json both = {{{"kind", "direct"}, {"channels", 1}},
                                 {{"kind", "indirect"}, {"channels", 1}}},
                         whole = {{{"kind", "combined"}, {"channels", 1}}};
};

TEST_F(TransferTerms, AreKeptByTheCompressor) {
    EXPECT_EQ(figures_of({"info", at("b.glb")})["transfer"]["terms"], both);
    EXPECT_EQ(figures_of({"compress", at("b.glb"), "-o", at("c.glb")})["terms"], both);
    EXPECT_EQ(figures_of({"info", at("c.glb")})["clustered_pca"]["terms"], both);
}

/// A model compressed for a light with its suns has a smaller error under it than one compressed for natural
/// light, with separate suns and with all light in the sky.
TEST_F(TransferTerms, AreCompressedForLightsWithSeparateSuns) {
    Light sky = hemisphere_light(3, {0, 1, 0}, glm::vec3(0.3f, 0.4f, 0.6f), glm::vec3(0.1f));
    nlohmann::json light = {{"prtkit_light", 1}, {"order", 3}};
    for (const auto& [c, name] : {std::pair(0, "red"), std::pair(1, "green"), std::pair(2, "blue")})
        for (const glm::vec3& coefficient : sky.coefficients)
            light["coefficients"][name].push_back(coefficient[c]);
    const Sun sun{glm::normalize(glm::vec3(0.3f, 0.8f, 0.5f)), glm::vec3(3), 0.01};
    light["suns"] = {{{"towards", {0.3, 0.8, 0.5}}, {"irradiance", {3, 3, 3}}, {"half_angle_radians", 0.01}}};
    folder.file("light.json", light.dump());
    const GltfDocument baked = load_gltf(folder / "b.glb");
    const Scene scene = extract_scene(baked);
    const Transfer reference = read_transfer(baked, scene)->transfer;
    const auto error_of = [&](std::vector<std::string> options, const Lighting& lighting) {
        options.insert(options.begin(), {"compress", at("b.glb"), "-o", at("c.glb"), "--bits", "float",
                                         "--clusters", "3", "--components", "2"});
        EXPECT_EQ(prt(options).status, 0);
        const GltfDocument coded = load_gltf(folder / "c.glb");
        return lit_rms(exit_radiance(reference, lighting),
                       exit_radiance(read_clustered(coded, extract_scene(coded))->transfer, lighting),
                       receiver_areas(scene));
    };
    const Light suns = as_light(sun, 3);
    for (const Lighting& lighting : {Lighting{sky, suns}, Lighting{sum(sky, suns)}})
        EXPECT_LT(error_of({"--lights", at("light.json")}, lighting),
                  1.05 * error_of({"--lights", "natural"}, lighting));
}

TEST_F(TransferTerms, AreCombinedOnRequest) {
    EXPECT_EQ(figures_of({"compress", at("b.glb"), "-o", at("c.glb"), "--combine-direct"})["terms"], whole);
    EXPECT_EQ(figures_of({"info", at("c.glb")})["clustered_pca"]["terms"], whole);
    // The bake represents equal light in other terms: all errors come from coding.
    const auto errors = figures_of({"evaluate", at("b.glb"), at("c.glb")});
    EXPECT_LT(errors["relative_l2"], 0.05);
    EXPECT_GT(errors["relative_l2"], 0);
    EXPECT_LT(errors["lights"][0]["lit_rms"], 0.05);
}

} // namespace
} // namespace prt::test
