// Tests files whose double-sided surfaces are split into two sides.

#include "bake/gltf/separate_sides.h"

#include "support/glb_elements.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

/// Returns a square of two triangles, both with material 0, and with all attributes that contain directions.
GlbFile square_file() {
    GlbFile file = test::triangle_file();
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, test::kFloat, "VEC3", 3);
    primitive["attributes"]["NORMAL"] =
        file.accessor(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, -128, 0, 0, 0},
                      test::kByte, "VEC3", 4, true, 4);
    primitive["attributes"]["TANGENT"] = file.accessor(
        std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, -1}, test::kFloat, "VEC4", 4);
    primitive["attributes"]["TEXCOORD_0"] =
        file.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, test::kFloat, "VEC2", 2);
    const std::size_t deltas =
        file.accessor(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, test::kFloat, "VEC3", 3);
    primitive["targets"] = {{{"POSITION", deltas}, {"NORMAL", deltas}}};
    primitive["indices"] =
        file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, test::kUnsignedShort, "SCALAR", 1);
    primitive["material"] = 0;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.json["materials"] = {{{"doubleSided", true}, {"extras", {{"keep", 1}}}}};
    return file;
}

struct Separated {
    Separated(const GlbFile& file, const std::vector<bool>& triangles) {
        file.write(folder / "in.glb");
        GltfDocument document = load_gltf(folder / "in.glb");
        before = extract_scene(document);
        const GltfDocument separate = with_separate_sides(std::move(document), before, triangles);
        after = extract_scene(separate);
        save_glb(separate, folder / "out.glb");
        written = test::read_glb(folder / "out.glb");
    }

    template <class T>
    std::vector<T> element(const Json& index, std::size_t i, std::size_t components) const {
        return test::glb_element<T>(written, index.get<std::size_t>(), i, components);
    }
    Json primitive(std::size_t index) const { return written.json["meshes"][0]["primitives"][index]; }
    bool double_sided(std::size_t index) const {
        return written.json["materials"][primitive(index)["material"].get<std::size_t>()].value("doubleSided",
                                                                                                false);
    }

    test::TemporaryFolder folder;
    Scene before, after;
    GlbFile written;
};

TEST(SeparateSides, FlipAllDirectionalAttributes) {
    const Separated file(square_file(), {true, true});
    ASSERT_EQ(file.written.json["meshes"][0]["primitives"].size(), 1u);
    EXPECT_FALSE(file.double_sided(0));
    ASSERT_EQ(file.written.json["materials"].size(), 1u); // nobody else has it
    EXPECT_EQ(file.written.json["materials"][0]["extras"]["keep"], 1);
    const Json attributes = file.primitive(0)["attributes"], target = file.primitive(0)["targets"][0];
    using Bytes = std::vector<std::int8_t>;
    using Floats = std::vector<float>;
    EXPECT_EQ(file.element<std::int8_t>(attributes["NORMAL"], 4, 3), (Bytes{0, 0, -127}));
    // the negative of -128
    EXPECT_EQ(file.element<std::int8_t>(attributes["NORMAL"], 7, 3), (Bytes{127, 0, 0}));
    EXPECT_EQ(file.element<float>(attributes["TANGENT"], 6, 4), (Floats{-1, -0.0f, -0.0f, 1}));
    EXPECT_EQ(file.element<float>(attributes["TEXCOORD_0"], 6, 2), (Floats{1, 1}));
    EXPECT_EQ(file.element<float>(target["POSITION"], 5, 3), (Floats{4, 5, 6}));
    EXPECT_EQ(file.element<float>(target["NORMAL"], 5, 3), (Floats{-4, -5, -6}));
    for (std::size_t v = 0; v < 4; ++v) { // the fronts are as they were
        EXPECT_EQ(file.after.vertex_arrays[0].positions[v], file.before.vertex_arrays[0].positions[v]);
        EXPECT_EQ(file.after.vertex_arrays[0].normals[v], file.before.vertex_arrays[0].normals[v]);
    }
    const auto& triangles = file.after.primitives[0].triangles;
    ASSERT_EQ(triangles.size(), 4u);
    EXPECT_EQ(triangles[0], glm::uvec3(0, 1, 2));
    EXPECT_EQ(triangles[2], glm::uvec3(4, 6, 5));
}

TEST(SeparateSides, LeaveTheOtherTrianglesDoubleSided) {
    const Separated file(square_file(), {false, true});
    ASSERT_EQ(file.written.json["meshes"][0]["primitives"].size(), 2u);
    EXPECT_TRUE(file.double_sided(0));
    EXPECT_FALSE(file.double_sided(1));
    EXPECT_EQ(file.primitive(0)["attributes"], file.primitive(1)["attributes"]);
    ASSERT_EQ(file.after.vertex_arrays.size(), 1u); // corners that both have are one receiver
    EXPECT_EQ(file.after.receivers(), 7u);
    EXPECT_EQ(file.after.triangles(), 3u);
    EXPECT_EQ(lamp_name(file.after, file.after.primitives[1].material), "material 0");
}

/// Returns a square with variants: material 1, and a second one that is `double_sided` or not.
GlbFile file_of_variants(bool double_sided) {
    GlbFile file = square_file();
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    file.json["materials"].push_back({{"name", "other"}, {"doubleSided", true}});
    file.json["materials"].push_back({{"name", "front"}, {"doubleSided", double_sided}});
    file.json["extensionsUsed"].push_back("KHR_materials_variants");
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}}, {{"name", "b"}}};
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                     {{"material", 2}, {"variants", {1}}}};
    return file;
}

TEST(SeparateSides, FollowVariantsAndKeepOtherMaterials) {
    GlbFile file = file_of_variants(true);
    Json plain = file.json["meshes"][0]["primitives"][0];
    plain.erase("extensions");
    plain["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(plain);
    const auto channel = [](const char* pointer) {
        return Json{
            {"sampler", 0},
            {"target",
             {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
    };
    const std::size_t times = file.accessor(std::vector<float>{0, 1}, test::kFloat, "SCALAR", 1);
    file.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", times}}}},
         {"channels", {channel("/materials/1/alphaCutoff"), channel("/materials/2/alphaCutoff")}}}};
    const Separated result(file, {true, true, false, false});
    EXPECT_FALSE(result.double_sided(0));
    EXPECT_TRUE(result.double_sided(1));
    const Json mappings = result.primitive(0)["extensions"]["KHR_materials_variants"]["mappings"];
    const auto& materials = result.written.json["materials"];
    const auto copy = mappings[0]["material"].get<std::size_t>();
    EXPECT_EQ(copy, 3u);
    EXPECT_EQ(materials[copy]["name"], "other");
    EXPECT_FALSE(materials[copy].contains("doubleSided"));
    EXPECT_EQ(mappings[1]["material"], 2); // nobody else has it
    EXPECT_FALSE(materials[2].contains("doubleSided"));
    const Json& channels = result.written.json["animations"][0]["channels"];
    ASSERT_EQ(channels.size(), 3u);
    EXPECT_EQ(channels[2]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
              "/materials/3/alphaCutoff");
}

TEST(SeparateSides, OmitSidesCulledByAVariant) {
    const Separated result(file_of_variants(false), {true, true});
    EXPECT_TRUE(result.double_sided(0));
    EXPECT_EQ(result.after.receivers(), result.before.receivers());
}

/// Nodes of one mesh, one of them mirrored, where one side of one of them is lit.
TEST(SeparateSides, BelongToANode) {
    GlbFile file = square_file();
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Separated result(file, {false, false, true, true});
    ASSERT_EQ(result.after.primitives.size(), 2u);
    EXPECT_EQ(result.after.primitives[0].triangles.size(), 2u);
    const Primitive& mirrored = result.after.primitives[1];
    ASSERT_EQ(mirrored.triangles.size(), 4u);
    const VertexArray& vertices = result.after.vertex_arrays[mirrored.vertices];
    for (std::size_t t = 0; t < 4; ++t) { // normals and winding agree
        const glm::uvec3& c = mirrored.triangles[t];
        const glm::vec3 &a = vertices.positions[c.x], &b = vertices.positions[c.y],
                        &d = vertices.positions[c.z];
        const float rotation = (b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x);
        EXPECT_GT(rotation * vertices.normals[c.x].z, 0) << t;
        EXPECT_EQ(vertices.normals[c.x].z, t < 2 ? 1 : -1) << t;
    }
}

/// Without normals in the file, too.
TEST(SeparateSides, HaveFlatNormals) {
    GlbFile file = square_file();
    Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes.erase("NORMAL");
    attributes.erase("TANGENT");
    const Separated result(file, {true, false});
    ASSERT_EQ(result.after.receivers(), 7u); // four corners, and three backs
    EXPECT_EQ(result.after.vertex_arrays[0].normals[6], glm::vec3(0, 0, -1));
}

} // namespace
} // namespace prt
