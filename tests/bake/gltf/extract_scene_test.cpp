// Tests the extraction of scenes from glTF documents.

#include "prt/gltf/gltf.h"

#include "prt/core/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace prt {
namespace {

using test::GlbFile;

Scene scene_of(const GlbFile& file) {
    const test::TemporaryFolder folder;
    file.write(folder / "scene.glb");
    return extract_scene(load_gltf(folder / "scene.glb"));
}

nlohmann::ordered_json& primitive(GlbFile& file) {
    return file.json["meshes"][0]["primitives"][0];
}

/// Four corners of a unit square in z = 0, in the order of a strip.
GlbFile strip_file(int mode, const std::vector<std::uint8_t>& indices) {
    GlbFile file = test::triangle_file();
    const auto position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, test::kFloat, "VEC3", 3);
    const auto normal =
        file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, test::kFloat, "VEC3", 3);
    primitive(file)["attributes"] = {{"POSITION", position}, {"NORMAL", normal}};
    primitive(file)["mode"] = mode;
    if (indices.empty())
        primitive(file).erase("indices");
    else
        primitive(file)["indices"] = file.accessor(indices, test::kUnsignedByte, "SCALAR", 1);
    return file;
}

/// Sum of the areas of all triangles, counted negative when they face away from +Z.
float signed_area(const Scene& scene) {
    float area = 0;
    for (const Primitive& p : scene.primitives)
        for (const glm::uvec3& t : p.triangles) {
            const auto& v = scene.vertex_arrays[p.vertices].positions;
            area += 0.5f * glm::cross(v[t.y] - v[t.x], v[t.z] - v[t.x]).z;
        }
    return area;
}

/// Returns the position of a vertex in the file's world space.
glm::vec3 world(const Scene& scene, const VertexArray& vertices, std::size_t i) {
    return glm::vec3(scene.world(vertices.positions[i]));
}

glm::vec3 first_position(const GlbFile& file, std::size_t i) {
    const Scene scene = scene_of(file);
    return world(scene, scene.vertex_arrays[0], i);
}

TEST(Triangles, StripsFansAndListsCoverTheSquareFromTheFront) {
    EXPECT_FLOAT_EQ(signed_area(scene_of(strip_file(5, {}))), 1);
    EXPECT_FLOAT_EQ(signed_area(scene_of(strip_file(5, {0, 1, 2, 3}))), 1);
    EXPECT_FLOAT_EQ(signed_area(scene_of(strip_file(6, {0, 1, 3, 2}))), 1);
    EXPECT_FLOAT_EQ(signed_area(scene_of(strip_file(4, {0, 1, 2, 2, 1, 3}))), 1);
}

TEST(Triangles, PointsAndLinesAreIgnoredWithANotice) {
    GlbFile file = test::triangle_file();
    file.json["meshes"][0]["primitives"].push_back(primitive(file));
    file.json["meshes"][0]["primitives"][1]["mode"] = 1;
    const Scene scene = scene_of(file);
    EXPECT_EQ(scene.primitives.size(), 1u);
    ASSERT_EQ(scene.notices.size(), 1u);
    EXPECT_NE(scene.notices[0].find("points, lines"), std::string::npos);
}

TEST(Triangles, EmptyPrimitivesAreIgnored) {
    GlbFile file = test::triangle_file();
    file.json["meshes"][0]["primitives"].push_back({{"attributes", nlohmann::ordered_json::object()}});
    file.json["meshes"][0]["primitives"].push_back(primitive(file));
    const auto nothing = file.accessor(std::vector<float>{}, test::kFloat, "VEC3", 3);
    file.json["meshes"][0]["primitives"][2]["attributes"] = {{"POSITION", nothing}, {"NORMAL", nothing}};
    const Scene scene = scene_of(file);
    EXPECT_EQ(scene.primitives.size(), 1u);
    EXPECT_EQ(scene.notices.size(), 1u);
}

TEST(Indices, AllTypesAreRead) {
    for (const int type : {test::kUnsignedByte, test::kUnsignedShort, test::kUnsignedInt}) {
        GlbFile file = test::triangle_file();
        const std::size_t size = type == test::kUnsignedByte ? 1 : type == test::kUnsignedShort ? 2 : 4;
        std::vector<std::byte> bytes(3 * size);
        for (std::uint32_t i = 0; i < 3; ++i)
            std::memcpy(&bytes[i * size], &i, size);
        primitive(file)["indices"] = file.accessor(bytes, 3, type, "SCALAR", false, 0);
        EXPECT_FLOAT_EQ(signed_area(scene_of(file)), 0.5f) << type;
    }
}

TEST(Nodes, HierarchyInstancesAndMirrorsTransformTheMesh) {
    GlbFile file = test::triangle_file();
    const double half = std::sqrt(0.5);
    file.json["nodes"] = {
        {{"translation", {10, 0, 0}}, {"children", {1, 2}}},
        {{"mesh", 0}, {"scale", {2, 3, 1}}},
        {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}},
        {{"mesh", 0}, {"rotation", {0, half, 0, half}}},
    };
    file.json["scenes"][0]["nodes"] = {0, 3};
    const Scene scene = scene_of(file);
    ASSERT_EQ(scene.primitives.size(), 3u);
    EXPECT_EQ(scene.receivers(), 9u); // instances are unique
    // Breadth first: the rotated one is a root.
    const auto& rotated = scene.vertex_arrays[scene.primitives[0].vertices];
    EXPECT_LT(glm::distance(world(scene, rotated, 1), glm::vec3(0, 0, -1)), 1e-6f);
    EXPECT_LT(glm::distance(rotated.normals[0], glm::vec3(1, 0, 0)), 1e-6f);
    const auto& scaled = scene.vertex_arrays[scene.primitives[1].vertices];
    EXPECT_LT(glm::distance(world(scene, scaled, 1), glm::vec3(12, 0, 0)), 1e-6f);
    EXPECT_LT(glm::distance(world(scene, scaled, 2), glm::vec3(10, 3, 0)), 1e-6f);
    // A mirror transform reverses the winding, so that the front side stays the front.
    EXPECT_TRUE(scene.primitives[2].mirrored);
    const auto& mirrored = scene.vertex_arrays[scene.primitives[2].vertices];
    const glm::uvec3 t = scene.primitives[2].triangles[0];
    EXPECT_GT(glm::cross(mirrored.positions[t.y] - mirrored.positions[t.x],
                         mirrored.positions[t.z] - mirrored.positions[t.x])
                  .z,
              0);
    EXPECT_LT(glm::distance(mirrored.normals[0], glm::vec3(0, 0, 1)), 1e-6f);
}

TEST(Nodes, FarFromTheOriginLoseNoDigits) {
    // A hundredth of a millimetre at a distance of a hundred kilometres: floats there have steps of 8 mm.
    const auto moved = [](double where) {
        GlbFile file = test::triangle_file();
        const double small = 1e-5;
        file.json["nodes"] = {
            {{"translation", {where, -where, where}}, {"children", {1}}},
            {{"mesh", 0}, {"scale", {small, small, small}}, {"translation", {0.1, 0.2, 0.3}}}};
        return scene_of(file);
    };
    const Scene here = moved(0), there = moved(1e5);
    EXPECT_NEAR(there.origin.x, 1e5 + 0.1, 1e-4);
    EXPECT_NEAR(there.origin.y, -1e5 + 0.2, 1e-4);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LT(glm::distance(here.vertex_arrays[0].positions[i], there.vertex_arrays[0].positions[i]),
                  1e-10f);
    EXPECT_NEAR(bounds(here).high.x - bounds(here).low.x, 1e-5f, 1e-11f);
}

TEST(Nodes, ShearedNormalsRemainPerpendicular) {
    GlbFile file = test::triangle_file();
    file.json["nodes"][0]["matrix"] = {1, 0, 2, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; // x also moves z
    const Scene scene = scene_of(file);
    const auto& v = scene.vertex_arrays[0];
    const glm::vec3 face =
        glm::normalize(glm::cross(v.positions[1] - v.positions[0], v.positions[2] - v.positions[0]));
    EXPECT_LT(glm::distance(v.normals[0], face), 1e-6f);
}

TEST(Accessors, SparseSubstitutionsAreMade) {
    GlbFile file = test::triangle_file();
    const std::vector<std::uint8_t> index = {2};
    const auto indices = file.view(std::as_bytes(std::span(index)));
    const std::vector<float> value = {0, 7, 0};
    const auto values = file.view(std::as_bytes(std::span(value)));
    auto& sparse = file.json["accessors"][0]["sparse"];
    sparse["count"] = 1;
    sparse["indices"] = {{"bufferView", indices}, {"componentType", test::kUnsignedByte}};
    sparse["values"]["bufferView"] = values;
    EXPECT_EQ(first_position(file, 2), glm::vec3(0, 7, 0));
    // Without a buffer view the rest is zero.
    file.json["accessors"][0].erase("bufferView");
    EXPECT_EQ(first_position(file, 1), glm::vec3(0));
}

TEST(Accessors, QuantisedAndInterleavedAttributesAreRead) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    // Shorts as positions, normalised bytes as normals, each padded to four bytes.
    const std::vector<std::int16_t> p = {0, 0, 0, 99, 300, 0, 0, 99, 0, 300, 0, 99};
    const std::vector<std::int8_t> n = {0, 0, 127, 99, 0, 0, 127, 99, 0, 0, 127, 99};
    primitive(file)["attributes"]["POSITION"] =
        file.accessor(std::as_bytes(std::span(p)), 3, test::kShort, "VEC3", false, 8);
    primitive(file)["attributes"]["NORMAL"] =
        file.accessor(std::as_bytes(std::span(n)), 3, test::kByte, "VEC3", true, 4);
    const std::vector<std::uint16_t> uv = {0, 65535, 65535, 0, 32768, 32768};
    primitive(file)["attributes"]["TEXCOORD_0"] = file.accessor(uv, test::kUnsignedShort, "VEC2", 2, true);
    const Scene scene = scene_of(file);
    const VertexArray& v = scene.vertex_arrays[0];
    EXPECT_EQ(world(scene, v, 1), glm::vec3(300, 0, 0));
    EXPECT_EQ(v.normals[2], glm::vec3(0, 0, 1));
    EXPECT_EQ(v.texcoords[0][0], glm::vec2(0, 1));
    EXPECT_NEAR(v.texcoords[0][2].x, 0.5f, 1e-4f);
}

TEST(Normals, MissingNormalsAreFlatAndSplitOnlyCreases) {
    GlbFile file = test::triangle_file();
    // Two coplanar triangles and one folded up, sharing vertices.
    const auto position = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1},
                                        test::kFloat, "VEC3", 3);
    primitive(file)["attributes"] = {{"POSITION", position}};
    primitive(file)["indices"] =
        file.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3, 0, 3, 4}, test::kUnsignedByte, "SCALAR", 1);
    const Scene scene = scene_of(file);
    const VertexArray& v = scene.vertex_arrays[0];
    EXPECT_EQ(v.size(), 7u); // four in the plane, three in the fold
    ASSERT_EQ(v.source.size(), 7u);
    for (const glm::uvec3& t : scene.primitives[0].triangles) {
        const glm::vec3 face = glm::normalize(
            glm::cross(v.positions[t.y] - v.positions[t.x], v.positions[t.z] - v.positions[t.x]));
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_LT(glm::distance(v.normals[t[corner]], face), 1e-6f);
    }
}

TEST(Normals, ZeroNormalsComeFromTrianglesAndOthersAreNormalized) {
    GlbFile file = test::triangle_file();
    const auto nan = std::nanf("");
    primitive(file)["attributes"]["NORMAL"] =
        file.accessor(std::vector<float>{0, 0, 0, 0, 0, -5, nan, 0, 1}, test::kFloat, "VEC3", 3);
    const Scene scene = scene_of(file);
    const VertexArray& v = scene.vertex_arrays[0];
    EXPECT_EQ(v.normals[0], glm::vec3(0, 0, 1));  // zero
    EXPECT_EQ(v.normals[1], glm::vec3(0, 0, -1)); // flipped normals are kept
    EXPECT_EQ(v.normals[2], glm::vec3(0, 0, 1));  // not a number
    EXPECT_EQ(scene.notices.size(), 1u);
}

TEST(Materials, FactorsTexturesAndModesAreRead) {
    GlbFile file = test::triangle_file();
    file.json["images"] = {{{"uri", "data:image/"
                                    "png;base64,"
                                    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA"
                                    "60e6kgAAAABJRU5ErkJggg=="}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
           {"baseColorTexture",
            {{"index", 0},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 1}}}}}}}}}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.7},
         {"doubleSided", true}}};
    primitive(file)["material"] = 0;
    const Scene scene = scene_of(file);
    const Material& m = scene.materials[scene.primitives[0].material];
    EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.7f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(m.base_color_texture.image, 0);
    EXPECT_EQ(m.base_color_texture.wrap_u, Wrap::clamp);
    EXPECT_EQ(m.base_color_texture.wrap_v, Wrap::mirror);
    EXPECT_EQ(m.base_color_texture.transform * glm::vec3(1, 1, 1), glm::vec2(2.5f, 1));
}

TEST(Skins, UseThePoseOfTheFile) {
    GlbFile file = test::triangle_file();
    primitive(file)["attributes"]["JOINTS_0"] = file.accessor(
        std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, test::kUnsignedByte, "VEC4", 4);
    primitive(file)["attributes"]["WEIGHTS_0"] =
        file.accessor(std::vector<float>{1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0, 2, 0, 0}, test::kFloat, "VEC4", 4);
    // Inverse bind: the second joint was bound at x = 1.
    std::vector<float> inverse(32, 0);
    for (const std::size_t i : {0u, 5u, 10u, 15u})
        inverse[i] = inverse[16 + i] = 1;
    inverse[16 + 12] = -1;
    const auto bind = file.accessor(inverse, test::kFloat, "MAT4", 16);
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    file.json["nodes"] = {
        {{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, // its own transform does not count
        {{"translation", {0, 0, 3}}},
        {{"translation", {1, 0, 5}}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = scene_of(file);
    const VertexArray& v = scene.vertex_arrays[0];
    EXPECT_EQ(world(scene, v, 0), glm::vec3(0, 0, 3));
    EXPECT_EQ(world(scene, v, 1), glm::vec3(1, 0, 4));
    EXPECT_EQ(world(scene, v, 2), glm::vec3(0, 1, 5));
    EXPECT_EQ(scene.notices.size(), 1u);
}

TEST(Morphs, UseTheWeightsOfTheFile) {
    GlbFile file = test::triangle_file();
    primitive(file)["targets"] = {{{"POSITION", file.accessor(std::vector<float>{0, 0, 2, 0, 0, 0, 0, 0, 0},
                                                              test::kFloat, "VEC3", 3)}}};
    file.json["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(first_position(file, 0), glm::vec3(0, 0, 1));
    file.json["nodes"][0]["weights"] = {0.0};
    EXPECT_EQ(first_position(file, 0), glm::vec3(0));
    file.json["nodes"][0]["weights"] = {0.25, 7.0, 7.0}; // two targets do not exist
    EXPECT_EQ(first_position(file, 0), glm::vec3(0, 0, 0.5f));
}

TEST(Nodes, BelongToTheDefaultOrFirstScene) {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0, 1, 2}}}, {{"nodes", {1}}}};
    file.json.erase("scene");
    EXPECT_EQ(scene_of(file).triangles(), 3u);
    file.json["scene"] = 1;
    EXPECT_EQ(scene_of(file).triangles(), 1u);
    file.json["scene"] = 2;
    EXPECT_THROW(scene_of(file), Error);
}

TEST(Nodes, WithoutScenesStartAtAllRoots) {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"mesh", 0}}, {{"mesh", 0}}};
    file.json.erase("scenes");
    file.json.erase("scene");
    EXPECT_EQ(scene_of(file).triangles(), 3u);
}

TEST(VertexArrays, AreSharedByPrimitivesWithEqualAccessors) {
    GlbFile file = test::triangle_file();
    file.json["meshes"][0]["primitives"].push_back(primitive(file));
    const Scene scene = scene_of(file);
    EXPECT_EQ(scene.primitives.size(), 2u);
    EXPECT_EQ(scene.vertex_arrays.size(), 1u);
    EXPECT_FLOAT_EQ(receiver_areas(scene)[0], 2 * 0.5f / 3);

    const auto cluster = file.accessor(std::vector<float>{0, 0, 0}, test::kFloat, "SCALAR", 1);
    file.json["meshes"][0]["primitives"][1]["attributes"]["_PRT_CLUSTER"] = cluster;
    EXPECT_EQ(scene_of(file).vertex_arrays.size(), 1u); // a bake would remove it

    const auto texcoord = file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, test::kFloat, "VEC2", 2);
    file.json["meshes"][0]["primitives"][1]["attributes"]["TEXCOORD_0"] = texcoord;
    const Scene separate = scene_of(file); // other texture coordinates are other vertices
    ASSERT_EQ(separate.vertex_arrays.size(), 2u);
    EXPECT_TRUE(separate.vertex_arrays[0].texcoords.empty());
    EXPECT_EQ(separate.vertex_arrays[1].texcoords.size(), 1u);
}

TEST(RealFiles, AreRead) {
    struct File {
        const char* name;
        std::size_t receivers, triangles;
    };
    for (const auto& [name, receivers, triangles] : {File{"mesh/bunny.glb", 35947, 69451},
                                                     {"mesh/knot.glb", 9881, 19520},
                                                     {"mesh/LeePerrySmith.glb", 9279, 17684},
                                                     {"mesh/DamagedHelmet/DamagedHelmet.gltf", 14556, 15452},
                                                     {"mesh/collision-world.glb", 2478, 1754}}) {
        const auto path = test::shared_file(name);
        if (path.empty())
            GTEST_SKIP() << name << " is not here";
        const Scene scene = extract_scene(load_gltf(path));
        EXPECT_EQ(scene.receivers(), receivers) << name;
        EXPECT_EQ(scene.triangles(), triangles) << name;
    }
}

} // namespace
} // namespace prt
