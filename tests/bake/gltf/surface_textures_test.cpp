// Attributes, textures and coordinates that are written into files.

#include "bake/gltf/vertex_splits.h"
#include "prt/gltf/gltf.h"

#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace prt {
namespace {

using test::GlbFile;

struct Written {
    test::TemporaryFolder folder;
    GltfDocument document;
    Scene scene;

    explicit Written(const GlbFile& file)
        : document([&] {
              file.write(folder / "in.glb");
              return load_gltf(folder / "in.glb");
          }()),
          scene(extract_scene(document)) {}
    GlbFile saved() const {
        save_glb(document, folder / "out.glb");
        return test::read_glb(folder / "out.glb");
    }
};

std::vector<std::byte> some_png() {
    return encode_png(2, 2, std::vector<glm::u8vec3>(4, glm::u8vec3(100)));
}

/// Returns two nodes with a triangle each, whose primitives share a material, and a third primitive of lines.
GlbFile shared_material() {
    GlbFile file = test::triangle_file();
    file.json["materials"] = {{{"name", "shared"}, {"extras", {{"keep", 1}}}}};
    auto primitive = file.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    auto lines = primitive;
    lines["mode"] = 1;
    file.json["meshes"] = {{{"primitives", {primitive}}}, {{"primitives", {primitive, lines}}}};
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"translation", {2, 0, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    return file;
}

TEST(SurfaceTextures, AssignAMaterialToEveryTexture) {
    Written written(shared_material());
    const SurfaceTexture one{.primitives = {0}, .texcoord = 0, .occlusion = some_png(), .bent_normals = {}},
        other{.primitives = {1},
              .texcoord = 3,
              .repeats = true,
              .occlusion = some_png(),
              .bent_normals = some_png()};
    write_surface_textures(written.document, written.scene, std::vector{one, other});
    const GlbFile file = written.saved();
    const auto material = [&](std::size_t mesh, std::size_t primitive) {
        return file.json["meshes"][mesh]["primitives"][primitive]["material"].get<std::size_t>();
    };
    EXPECT_EQ(material(1, 1), 0u); // lines keep their material
    EXPECT_FALSE(file.json["materials"][0].contains("occlusionTexture"));
    const auto &a = file.json["materials"][material(0, 0)], &b = file.json["materials"][material(1, 0)];
    EXPECT_EQ(a["name"], "shared");
    EXPECT_EQ(b["extras"]["keep"], 1);
    EXPECT_EQ(a["occlusionTexture"]["texCoord"], 0);
    EXPECT_EQ(b["occlusionTexture"]["texCoord"], 3);
    EXPECT_NE(a["occlusionTexture"]["index"], b["occlusionTexture"]["index"]);
    EXPECT_FALSE(a["extras"].contains("prtkit"));
    const auto sampler = [&](const auto& m) {
        const std::size_t texture = m["occlusionTexture"]["index"].template get<std::size_t>();
        return file.json["samplers"][file.json["textures"][texture]["sampler"].template get<std::size_t>()];
    };
    EXPECT_EQ(sampler(a)["wrapS"], 33071);
    EXPECT_EQ(sampler(b)["wrapT"], 10497);
}

TEST(SurfaceTextures, IncludeVariants) {
    GlbFile given = shared_material();
    given.json["meshes"][1]["primitives"].erase(1);
    given.json["materials"].push_back({{"name", "other"}, {"occlusionTexture", {{"index", 0}}}});
    given.json["images"] = {{{"mimeType", "image/png"}, {"bufferView", given.view(some_png())}}};
    given.json["textures"] = {{{"source", 0}}};
    given.json["extensionsUsed"] = {"KHR_materials_variants"};
    given.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "v"}}};
    for (auto& mesh : given.json["meshes"])
        mesh["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
            {{"material", 1}, {"variants", {0}}}};
    Written written(given);
    const std::size_t replaced =
        write_surface_textures(written.document, written.scene,
                               std::vector{SurfaceTexture{{0}, 0, false, some_png(), {}},
                                           SurfaceTexture{{1}, 0, false, some_png(), {}}});
    EXPECT_EQ(replaced, 2u);
    const GlbFile file = written.saved();
    std::vector<std::size_t> textures;
    for (const auto& mesh : file.json["meshes"]) {
        const auto& primitive = mesh["primitives"][0];
        const auto texture = [&](const auto& choice) {
            return file
                .json["materials"][choice["material"].template get<std::size_t>()]["occlusionTexture"]
                     ["index"]
                .template get<std::size_t>();
        };
        textures.push_back(texture(primitive));
        EXPECT_EQ(texture(primitive["extensions"]["KHR_materials_variants"]["mappings"][0]), textures.back());
    }
    EXPECT_NE(textures[0], textures[1]);
}

TEST(SurfaceTextures, ReuseUnsharedMaterials) {
    GlbFile given = shared_material();
    given.json["meshes"][1]["primitives"].erase(1);
    given.json["meshes"][0]["primitives"][0].erase("material");
    Written written(given);
    write_surface_textures(written.document, written.scene,
                           std::vector{SurfaceTexture{{0, 1}, 0, false, some_png(), {}}});
    const GlbFile file = written.saved();
    EXPECT_EQ(file.json["materials"].size(), 2u); // that, and one for the primitive without
    EXPECT_EQ(file.json["meshes"][1]["primitives"][0]["material"], 0);
    EXPECT_EQ(file.json["meshes"][0]["primitives"][0]["material"], 1);
}

TEST(SurfaceTextures, RejectExtrasOtherThanObjects) {
    GlbFile given = shared_material();
    given.json["materials"][0]["extras"] = "a word";
    Written written(given);
    EXPECT_THROW(
        write_surface_textures(written.document, written.scene,
                               std::vector{SurfaceTexture{{0, 1}, 0, false, some_png(), some_png()}}),
        Error);
}

TEST(VertexColors, AreShaded) {
    GlbFile given = test::triangle_file();
    const auto color = given.accessor(std::vector<float>{1, 0.5f, 0.25f, 0.5f, 1, 1, 1, 1, 0, 0, 0, 1},
                                      test::kFloat, "VEC4", 4);
    given.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = color;
    Written written(given);
    write_vertex_attributes(written.document, written.scene,
                            std::vector{shaded_vertex_colors(written.scene, std::vector{0.5f, 0.25f, 1.0f}),
                                        VertexAttribute{"_A", 1, {1, 2, 3}}});
    written.saved();
    const Scene again = extract_scene(load_gltf(written.folder / "out.glb"));
    EXPECT_EQ(again.vertex_arrays[0].colors[0], glm::vec4(0.5f, 0.25f, 0.125f, 0.5f));
    EXPECT_EQ(again.vertex_arrays[0].colors[1], glm::vec4(0.25f, 0.25f, 0.25f, 1));
}

TEST(VertexSplits, CopyAllAttributes) {
    GlbFile given = shared_material();
    given.json["meshes"][1]["primitives"].erase(1);
    given.json["nodes"][1]["scale"] = {-1, 1, 1}; // mirrored
    const auto color = given.accessor(std::vector<std::uint8_t>{9, 0, 0, 255, 8, 0, 0, 255, 7, 0, 0, 255},
                                      test::kUnsignedByte, "VEC4", 4, true);
    given.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = color;
    Written written(given);
    EXPECT_EQ(free_texcoord(written.scene), 0);
    // A separate vertex for every corner, and one more that is split.
    const VertexSplit split{{2, 1, 0, 1}, {{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}, {0.7f, 0.8f}}, {}};
    std::vector<VertexSplit> splits(2, split);
    for (std::size_t p = 0; p < 2; ++p) {
        const glm::uvec3& t = written.scene.primitives[p].triangles[0];
        splits[p].triangles = {glm::uvec3(2 - t.x, t.y == 1 ? 3 : 2 - t.y, t.z == 1 ? 3 : 2 - t.z)};
    }
    const GltfDocument document = with_texcoords(std::move(written.document), written.scene, splits, 1);
    const Scene again = extract_scene(document);
    ASSERT_EQ(again.primitives.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p) {
        const VertexArray &now = again.vertex_arrays[again.primitives[p].vertices],
                          &before = written.scene.vertex_arrays[written.scene.primitives[p].vertices];
        ASSERT_EQ(now.texcoords.size(), 2u); // both sets, since glTF counts without gaps
        EXPECT_EQ(now.texcoords[1], split.uv);
        EXPECT_EQ(now.texcoords[0], std::vector<glm::vec2>(4, glm::vec2(0)));
        ASSERT_EQ(now.size(), 4u);
        for (std::size_t v = 0; v < 4; ++v)
            EXPECT_EQ(now.positions[v], before.positions[split.source[v]]);
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(now.positions[again.primitives[p].triangles[0][i]],
                      before.positions[written.scene.primitives[p].triangles[0][i]]);
        if (!before.colors.empty()) {
            EXPECT_EQ(now.colors[0], before.colors[2]);
        }
    }
}

} // namespace
} // namespace prt
