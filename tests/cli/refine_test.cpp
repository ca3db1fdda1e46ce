// prt bake --refine, from the command line to the file.

#include "bake/gltf/encode_glb.h"
#include "pipeline.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"

#include <algorithm>

namespace prt::test {
namespace {

TEST_F(Pipeline, RefinementIsReported) {
    copy_examples(folder.path(), {"plain_room"});
    const Outcome bake = prt({"bake", at("plain_room.glb"), "-o", at("b.glb"), "--order", "3", "--rays", "64",
                              "--refine", "0.1", "--json", at("b.json"), "--device", "cpu"});
    ASSERT_EQ(bake.status, 0) << bake.err;
    EXPECT_NE(bake.out.find("refined in "), std::string::npos) << bake.out;
    const auto report = read_json(folder / "b.json");
    EXPECT_EQ(report["refine_end"], "target");
    EXPECT_LE(report["refine_error_relative_l2"], 0.1);
    EXPECT_GT(report["refine_error_before_relative_l2"], 0.3);
    EXPECT_EQ(report["fit"], "surface");
    const GltfDocument document = load_gltf(folder / "b.glb");
    const Scene scene = extract_scene(document);
    EXPECT_EQ(scene.receivers(), report["vertices_after"]);
    EXPECT_EQ(scene.triangles(), report["triangles_after"]);
    EXPECT_GT(scene.receivers(), static_cast<std::size_t>(report["vertices_before"]) + 100);
    ASSERT_TRUE(read_transfer(document, scene));
    const Outcome compress = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "4"});
    EXPECT_EQ(compress.status, 0) << compress.err;
    if (validator_errors(folder / "b.glb") < 0)
        GTEST_SKIP() << "gltf-validator is not installed";
}

TEST_F(Pipeline, RefinementKeepsTheVertexLimit) {
    copy_examples(folder.path(), {"plain_room"});
    const Outcome bake = prt({"bake", at("plain_room.glb"), "-o", at("b.glb"), "--order", "3", "--rays", "64",
                              "--refine", "0.05", "--refine", "vertices=600", "--device", "cpu"});
    ASSERT_EQ(bake.status, 0) << bake.err;
    EXPECT_NE(bake.out.find("within the vertex limit"), std::string::npos) << bake.out;
    const std::size_t vertices = extract_scene(load_gltf(folder / "b.glb")).receivers();
    EXPECT_LE(vertices, 600);
    EXPECT_GT(vertices, 580);
}

TEST_F(Pipeline, RejectsUnsupportedRefinement) {
    triangle_file().write(folder / "t.glb");
    const auto bake = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"bake", at("t.glb"), "-o", at("b.glb")});
        return prt(options);
    };
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--refine", "0.02", "--fit", "vertex"}}) {
        const Outcome refused = bake(options);
        EXPECT_EQ(refused.status, 1);
        EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
        EXPECT_NE(refused.err.find("refine"), std::string::npos) << refused.err;
    }
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--refine", "0"},
                                               {"--refine", "much"},
                                               {"--refine", "vertices=9"},
                                               {"--refine", "0.1", "--refine", "vertices=0"}})
        EXPECT_EQ(bake(options).status, 2);
    EXPECT_EQ(bake({"--refine", "0.02", "--rays", "16"}).status, 0); // no triangle needs a split
}

} // namespace
} // namespace prt::test
