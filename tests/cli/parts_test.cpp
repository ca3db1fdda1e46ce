// Parts of transfer on the road from the bake to what is shipped.

#include "program.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace prt::test {
namespace {

class Parts : public testing::Test {
protected:
    void SetUp() override {
        scene_file(SceneBuilder().floor({0, 0, 0}, 1, 6).sphere({0, 0.6f, 0}, 0.4f, 8).build())
            .write(folder / "s.glb");
        ASSERT_EQ(
            prt({"bake", at("s.glb"), "-o", at("b.glb"), "--rays", "64", "--order", "3", "--bounces", "1"})
                .status,
            0);
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
                         whole = {{{"kind", "whole"}, {"channels", 1}}};
};

TEST_F(Parts, OfABakeWithBouncesAreKeptByTheCompressor) {
    EXPECT_EQ(figures_of({"info", at("b.glb")})["transfer"]["parts"], both);
    EXPECT_EQ(figures_of({"compress", at("b.glb"), "-o", at("c.glb")})["parts"], both);
    EXPECT_EQ(figures_of({"info", at("c.glb")})["clustered_pca"]["parts"], both);
}

TEST_F(Parts, AreMadeOneWhereTheUserAsksForIt) {
    EXPECT_EQ(figures_of({"compress", at("b.glb"), "-o", at("c.glb"), "--whole"})["parts"], whole);
    EXPECT_EQ(figures_of({"info", at("c.glb")})["clustered_pca"]["parts"], whole);
    // The bake is the same light in other parts: all errors are of the coding.
    const auto errors = figures_of({"evaluate", at("b.glb"), at("c.glb")});
    EXPECT_LT(errors["relative_l2"], 0.05);
    EXPECT_GT(errors["relative_l2"], 0);
    EXPECT_LT(errors["lights"][0]["lit_rms"], 0.05);
}

} // namespace
} // namespace prt::test
