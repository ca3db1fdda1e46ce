// Both sides of double-sided surfaces, from the command line to the file.

#include "prt/encode_glb.h"
#include "prt/gltf.h"
#include "prt/support/file.h"
#include "road.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

namespace prt::test {
namespace {

/// A roof over a floor, both of double-sided materials: light reaches both sides of the roof.
GlbFile roof_file() {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 2, 4).floor({0, 1, 0}, 1, 3).build());
    file.json["materials"] = {{{"name", "board"}, {"doubleSided", true}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

class BackSides : public Road {
protected:
    Outcome bake(const char* scene, const char* output, std::vector<std::string> options = {}) {
        options.insert(options.begin(), {"bake", at(scene), "-o", at(output), "--order", "2", "--rays", "64",
                                         "--bounces", "1", "--backend", "cpu", "--json", at("b.json")});
        return prt(options);
    }
};

TEST_F(BackSides, GetVerticesWhereLightReachesThem) {
    roof_file().write(folder / "roof.glb");
    const std::size_t fronts = extract_scene(load_gltf(folder / "roof.glb")).receivers();
    const Outcome baked = bake("roof.glb", "b.glb");
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("both sides of 18 double-sided triangles: 54 vertices more"), std::string::npos)
        << baked.err;
    EXPECT_EQ(baked.out.find("seen from behind"), std::string::npos) << baked.out;
    EXPECT_EQ(read_json(folder / "b.json")["receivers"], fronts + 54);
    const GltfDocument document = load_gltf(folder / "b.glb");
    const Scene scene = extract_scene(document);
    const auto transfer = read_transfer(document, scene);
    ASSERT_TRUE(transfer);
    double above = 0, below = 0; // what the roof sees of a uniform sky
    const VertexArray& vertices = scene.vertex_arrays[0];
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (vertices.positions[v].y > 0.1f)
            (vertices.normals[v].y > 0 ? above : below) +=
                static_cast<double>(transfer->transfer.vector(v)[0]);
    EXPECT_GT(above, 1.5 * below);
    EXPECT_GT(below, 0);

    // The file is a scene like any other: the same comes out of it, and it compresses.
    const Outcome again = bake("b.glb", "again.glb");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(read_file(folder / "again.glb"), read_file(folder / "b.glb"));
    const Outcome compressed = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "2"});
    EXPECT_EQ(compressed.status, 0) << compressed.err;
    EXPECT_NE(validator_errors(folder / "b.glb"), 1);
}

TEST_F(BackSides, ShowTheLightOfTheFrontWhereTheyShareIt) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--back-sides", "shared"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_EQ(baked.err.find("both sides"), std::string::npos) << baked.err;
    EXPECT_NE(baked.out.find("seen from behind"), std::string::npos) << baked.out;
    EXPECT_EQ(extract_scene(load_gltf(folder / "b.glb")).receivers(),
              extract_scene(load_gltf(folder / "roof.glb")).receivers());
}

TEST_F(BackSides, HaveChartsOfTheirOwnInALightmap) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--size", "64", "--unwrap"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("both sides of 18"), std::string::npos) << baked.err;
    EXPECT_EQ(extract_scene(load_gltf(folder / "b.glb")).triangles(), 32u + 2 * 18);
}

TEST_F(BackSides, ComeAfterARefinement) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--refine", "0.02"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("both sides of "), std::string::npos) << baked.err;
    EXPECT_NE(baked.out.find("refined in "), std::string::npos) << baked.out;
    EXPECT_GT(extract_scene(load_gltf(folder / "b.glb")).triangles(), 2 * 32u);
}

} // namespace
} // namespace prt::test
