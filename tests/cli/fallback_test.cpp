// prt compress --fallback: other viewers have a lit picture, and prt has the one that it had.

#include "pipeline.h"
#include "prt/image/image_file.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <gtest/gtest.h>

namespace prt::test {
namespace {

class FallbackFiles : public Pipeline {
protected:
    void SetUp() override {
        scene_file(SceneBuilder().floor({0, 0, 0}, 2, 6).sphere({0, 0.8f, 0}, 0.7f, 8).build())
            .write(folder / "t.glb");
        std::vector<glm::vec3> sky(8 * 4, glm::vec3(0.2f, 0.3f, 0.5f));
        sky[10] = glm::vec3(40, 30, 20);
        write_exr(folder / "sky.exr", {8, 4, sky});
        prt_once("b.glb", {"bake", at("t.glb"), "--rays", "32", "--order", "3"}, folder / "b.glb");
    }
    Outcome compress(const char* output, const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"compress",   at("b.glb"), "-o",     at(output),
                                              "--clusters", "4",         "--json", at("c.json")};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
};

TEST_F(FallbackFiles, IsWrittenAndChangesNoPictureOfPrt) {
    ASSERT_EQ(compress("plain.glb", {}).status, 0);
    const std::vector<std::vector<std::string>> ways = {{}, {"--meshopt"}, {"--reorder"}};
    for (std::vector<std::string> way : ways) {
        way.insert(way.end(), {"--fallback", at("sky.exr")});
        const Outcome outcome = compress("shown.glb", way);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("viewers without PRT show the model lit by sky.exr, at exposure "),
                  std::string::npos)
            << outcome.out;
        const double exposure = read_json(folder / "c.json")["fallback"]["exposure"];
        EXPECT_GT(exposure, 0);
        const GlbFile file = read_glb(folder / "shown.glb");
        EXPECT_EQ(set_of(file.json, "vertices")["fallback"]["exposure"], exposure);
        EXPECT_TRUE(file.json["materials"][0]["extensions"].contains("KHR_materials_unlit"));
        EXPECT_TRUE(file.json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
        const int errors = validator_errors(folder / "shown.glb");
        EXPECT_LE(errors, 0);
        for (const char* name : {"plain", "shown"})
            ASSERT_EQ(
                prt({"render", at((std::string(name) + ".glb").c_str()), "--lights", at("sky.exr"), "-o",
                     at((std::string(name) + ".png").c_str()), "--size", "64x48", "--samples", "1"})
                    .status,
                0);
        EXPECT_EQ(read_file(folder / "plain.png"), read_file(folder / "shown.png"));
    }
}

TEST_F(FallbackFiles, IsNotInBakesOfItsFile) {
    ASSERT_EQ(compress("shown.glb", {"--fallback", at("sky.exr")}).status, 0);
    ASSERT_EQ(prt({"bake", at("shown.glb"), "-o", at("again.glb"), "--rays", "4"}).status, 0);
    const std::string text = read_glb(folder / "again.glb").json.dump();
    for (const char* word : {"KHR_materials_unlit", "COLOR_0", "fallback", "clustered"})
        EXPECT_EQ(text.find(word), std::string::npos) << word;
}

TEST_F(FallbackFiles, IsRejectedBeforeWorkBegins) {
    const Outcome outcome = compress("shown.glb", {"--fallback", at("gone.exr")});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("gone.exr"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "shown.glb"));
}

} // namespace
} // namespace prt::test
