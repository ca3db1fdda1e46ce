// Both sides of double-sided surfaces, from the command line to the file.

#include "bake/gltf/encode_glb.h"
#include "pipeline.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/levels.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <array>
#include <map>
#include <set>

namespace prt::test {
namespace {

/// A roof over a floor, both of double-sided materials: light reaches the backs of the roof.
GlbFile roof_file() {
    GlbFile file = scene_file(SceneBuilder().floor({0, 0, 0}, 2, 4).floor({0, 1, 0}, 1, 3).build());
    file.json["materials"] = {{{"name", "board"}, {"doubleSided", true}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

class BackSides : public Pipeline {
protected:
    Outcome bake(const char* scene, const char* output, std::vector<std::string> options = {}) {
        options.insert(options.begin(), {"bake", at(scene), "-o", at(output), "--order", "2", "--rays", "64",
                                         "--bounces", "1", "--device", "cpu", "--json", at("b.json")});
        return prt(options);
    }
};

TEST_F(BackSides, GetVerticesIfLightReachesThem) {
    roof_file().write(folder / "roof.glb");
    const std::size_t fronts = extract_scene(load_gltf(folder / "roof.glb")).receivers();
    const Outcome baked = bake("roof.glb", "b.glb");
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("the back sides of 18 double-sided triangles; 54 vertices were added"),
              std::string::npos)
        << baked.err;
    EXPECT_EQ(baked.out.find("show the light of the front sides"), std::string::npos) << baked.out;
    EXPECT_EQ(read_json(folder / "b.json")["receivers"], fronts + 54);
    const GltfDocument document = load_gltf(folder / "b.glb");
    const Scene scene = extract_scene(document);
    const auto transfer = read_transfer(document, scene);
    ASSERT_TRUE(transfer);
    double above = 0, below = 0; // visible fraction of a uniform sky above and below the roof
    const VertexArray& vertices = scene.vertex_arrays[0];
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (vertices.positions[v].y > 0.1f)
            (vertices.normals[v].y > 0 ? above : below) +=
                static_cast<double>(transfer->transfer.vector(v)[0]);
    EXPECT_GT(above, 1.5 * below);
    EXPECT_GT(below, 0);

    // The file is an ordinary scene: baking it again changes nothing, and it can be compressed.
    const Outcome again = bake("b.glb", "again.glb");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(read_file(folder / "again.glb"), read_file(folder / "b.glb"));
    const Outcome compressed = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--clusters", "2"});
    EXPECT_EQ(compressed.status, 0) << compressed.err;
    EXPECT_NE(validator_errors(folder / "b.glb"), 1);
}

/// A roof of leaves: light from above passes to its underside, in the color that the leaves transmit.
TEST_F(BackSides, OfLeavesShowTheLightThatPasses) {
    GlbFile file = roof_file();
    file.json["extensionsUsed"] = {"KHR_materials_diffuse_transmission"};
    file.json["materials"][0]["extensions"]["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0, 1, 0}}};
    file.write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb");
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("the back sides of "), std::string::npos) << baked.err;
    const GltfDocument document = load_gltf(folder / "b.glb");
    const Scene scene = extract_scene(document);
    EXPECT_EQ(scene.triangles(), 2 * extract_scene(load_gltf(folder / "roof.glb")).triangles());
    const auto transfer = read_transfer(document, scene);
    ASSERT_TRUE(transfer);
    ASSERT_EQ(transfer->transfer.layout.channels(), 3);
    const VertexArray& vertices = scene.vertex_arrays[0];
    for (std::size_t v = 0; v < vertices.size(); ++v)
        if (vertices.positions[v].y > 0.1f) {
            // Direct light from above in red and green: the basis function of y is negative there.
            const float red = -transfer->transfer.vector(v)[1], green = -transfer->transfer.vector(v)[5];
            EXPECT_EQ(red > 0, vertices.normals[v].y > 0) << v;
            EXPECT_EQ(red > green, vertices.normals[v].y > 0) << v;
        }
}

TEST_F(BackSides, ShareTheLightOfTheFront) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--back-sides", "shared"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_EQ(baked.err.find("the back sides of"), std::string::npos) << baked.err;
    EXPECT_NE(baked.out.find("show the light of the front sides"), std::string::npos) << baked.out;
    EXPECT_EQ(extract_scene(load_gltf(folder / "b.glb")).receivers(),
              extract_scene(load_gltf(folder / "roof.glb")).receivers());
}

TEST_F(BackSides, HaveSeparateLightmapCharts) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--texels", "64", "--texels", "unwrap"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.err.find("the back sides of 18"), std::string::npos) << baked.err;
    EXPECT_EQ(extract_scene(load_gltf(folder / "b.glb")).triangles(), 32u + 2 * 18);
}

/// Both sides are split in the same way: every triangle of the roof still has its opposite.
TEST_F(BackSides, AreRefinedLikeFronts) {
    roof_file().write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb", {"--refine", "0.005"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_NE(baked.out.find("refined in "), std::string::npos) << baked.out;
    const Scene scene = extract_scene(load_gltf(folder / "b.glb"));
    std::map<std::set<std::array<float, 3>>, int> rotated; // triangles by their corners: up minus down
    std::size_t roof = 0;
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles) {
            const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
            if (vertices.positions[t.x].y < 0.1f)
                continue;
            std::set<std::array<float, 3>> corners;
            for (int i = 0; i < 3; ++i)
                corners.insert(
                    {vertices.positions[t[i]].x, vertices.positions[t[i]].y, vertices.positions[t[i]].z});
            rotated[corners] += vertices.normals[t.x].y > 0 ? 1 : -1;
            ++roof;
        }
    EXPECT_GT(roof, 2 * 18u);
    for (const auto& [corners, sum] : rotated)
        EXPECT_EQ(sum, 0);
}

/// A variant that culls back faces keeps the mesh unchanged, also if flat normals split its vertices.
TEST_F(BackSides, AreKeptIfAVariantCullsThem) {
    GlbFile file = triangle_file();
    const std::size_t tent = file.accessor(
        std::vector<float>{-1, 0.5f, 1, 0, 1, 1, 1, 0.5f, 1, -1, 0.5f, -1, 0, 1, -1, 1, 0.5f, -1}, kFloat,
        "VEC3", 3);
    file.json["accessors"][tent]["min"] = {-1, 0.5, -1};
    file.json["accessors"][tent]["max"] = {1, 1, 1};
    const std::size_t indices = file.accessor(std::vector<std::uint16_t>{0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4},
                                              kUnsignedShort, "SCALAR", 1);
    file.json["materials"] = {{{"name", "cloth"}, {"doubleSided", true}}};
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"] = {{"POSITION", tent}};
    primitive["indices"] = indices;
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
    file.json["materials"].push_back({{"name", "front"}});
    file.json["extensionsUsed"] = {"KHR_materials_variants"};
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}}};
    file.write(folder / "roof.glb");
    const Outcome baked = bake("roof.glb", "b.glb");
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_EQ(baked.err.find("the back sides of"), std::string::npos) << baked.err;
    const Scene before = extract_scene(load_gltf(folder / "roof.glb")),
                after = extract_scene(load_gltf(folder / "b.glb"));
    EXPECT_EQ(after.vertex_arrays[0].positions, before.vertex_arrays[0].positions);
    EXPECT_EQ(after.vertex_arrays[0].normals, before.vertex_arrays[0].normals);
    EXPECT_NE(validator_errors(folder / "b.glb"), 1);
}

/// The underside of the roof is not as open as its top.
TEST_F(BackSides, HaveSeparateOcclusion) {
    roof_file().write(folder / "roof.glb");
    const Outcome ao = prt({"ao", at("roof.glb"), "-o", at("b.glb"), "--rays", "64", "--attribute", "_AO"});
    ASSERT_EQ(ao.status, 0) << ao.err;
    EXPECT_NE(ao.err.find("the back sides of 18 "), std::string::npos) << ao.err;
    EXPECT_EQ(extract_scene(load_gltf(folder / "b.glb")).triangles(), 32u + 2 * 18);
    EXPECT_NE(validator_errors(folder / "b.glb"), 1);
}

/// Both levels get back sides, with equal kinds of light.
TEST_F(BackSides, ExistInCoarserLevels) {
    GlbFile file = roof_file();
    file.json["meshes"].push_back(file.json["meshes"][0]);
    file.json["nodes"].push_back({{"name", "coarse"}, {"mesh", 1}});
    file.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {1};
    file.json["extensionsUsed"] = {"MSFT_lod"};
    file.write(folder / "roof.glb");
    for (const char* mode : {"carry", "own"}) {
        const Outcome baked = bake("roof.glb", "b.glb", {"--levels", mode});
        ASSERT_EQ(baked.status, 0) << mode << baked.err;
        EXPECT_NE(baked.err.find("the back sides of 36 "), std::string::npos) << baked.err;
        const LeveledScene levels = extract_levels(load_gltf(folder / "b.glb"));
        EXPECT_EQ(levels.scene.receivers(), 2 * levels.finest_receivers) << mode;
    }
}

/// Instances share the vertices of both sides, also as EXT_mesh_gpu_instancing and next to a mirrored node.
TEST_F(BackSides, AreSharedByInstances) {
    for (const bool instancing : {false, true}) {
        GlbFile file = roof_file();
        const std::size_t floor =
            file.accessor(std::vector<float>{0, 0, 0, 0, 0, 1000, 0, 0, 2000}, kFloat, "VEC3", 3);
        file.json["nodes"] = {{{"mesh", 0}, {"translation", {500, 0, 0}}, {"scale", {-1, 1, 1}}}};
        if (instancing) {
            file.json["nodes"].push_back({{"mesh", 0}});
            file.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
                floor;
            file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
            file.json["scenes"] = {{{"nodes", {0, 1}}}};
        } else {
            for (const int z : {0, 1000, 2000})
                file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, z}}});
            file.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
        }
        file.write(folder / "roof.glb");
        const std::size_t fronts = extract_scene(load_gltf(folder / "roof.glb")).receivers();
        ASSERT_EQ(bake("roof.glb", "own.glb").status, 0);
        const Outcome baked = bake("roof.glb", "shared.glb", {"--instances", "shared"});
        ASSERT_EQ(baked.status, 0) << baked.err;
        EXPECT_NE(baked.err.find("the back sides of 72 double-sided triangles; 216 vertices were added"),
                  std::string::npos)
            << baked.err;
        const nlohmann::json told = read_json(folder / "b.json");
        EXPECT_EQ(told["receivers"], fronts + 4 * 54);
        EXPECT_EQ(told["receivers_stored"], (fronts + 4 * 54) / 2); // of the mesh, and of the mirrored node
        EXPECT_EQ(told["instances"]["shared"], 3);
        EXPECT_NE(validator_errors(folder / "shared.glb"), 1);
        EXPECT_EQ(read_glb(folder / "shared.glb").json["nodes"].size(), instancing ? 2u : 4u);
        const Outcome compared =
            prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")});
        ASSERT_EQ(compared.status, 0) << compared.err;
        // The same light except for the noise of 64 rays; the light of the front would be twice as strong.
        EXPECT_LT(read_json(folder / "errors.json")["relative_l2"], 0.1);
    }
}

/// The underside of the roof is unshadowed if its material casts no shadow, also in texels.
TEST_F(BackSides, SeeThroughMaterialsWithoutShadow) {
    scene_file(SceneBuilder().floor({0, 1, 0}, 1, 3).sphere({0, 1, 0}, 3, 8).build())
        .write(folder / "plain.glb");
    GlbFile file = read_glb(folder / "plain.glb");
    file.json["materials"] = {{{"name", "board"}, {"doubleSided", true}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "closed.glb");
    const std::vector<std::string> texels{"--texels", "128", "--texels", "unwrap"},
        shell{"--no-shadow", "board"};
    for (const bool in_texels : {false, true})
        for (const bool open : {false, true}) {
            std::vector<std::string> options = in_texels ? texels : std::vector<std::string>{};
            if (open)
                options.insert(options.end(), shell.begin(), shell.end());
            const Outcome baked = bake("closed.glb", "b.glb", options);
            ASSERT_EQ(baked.status, 0) << baked.err;
            EXPECT_EQ(baked.err.find("the back sides of ") != std::string::npos, open)
                << in_texels << baked.err;
        }
}

} // namespace
} // namespace prt::test
