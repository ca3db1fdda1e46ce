// Tests refined files and scenes: the attributes of a vertex in the middle of an edge.

#include "prt/gltf/refinement.h"

#include "bake/gltf/encode_glb.h"
#include "prt/core/error.h"
#include "support/glb_elements.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

/// The first edge of the one triangle of primitive 0 is split.
Refinement first_edge_split(const Scene& scene) {
    Refinement refinement = no_refinement(scene);
    const auto middle = static_cast<std::uint32_t>(scene.vertex_arrays[0].size());
    refinement.midpoints[0] = {{0, 1}};
    const glm::uvec3 t = scene.primitives[0].triangles[0];
    refinement.triangles[0] = {{t.x, middle, t.z}, {middle, t.y, t.z}};
    return refinement;
}

/// A file, and its version with more vertices.
struct Finer {
    explicit Finer(const GlbFile& file) {
        file.write(folder / "file.glb");
        GltfDocument document = load_gltf(folder / "file.glb");
        const Scene before = extract_scene(document);
        const Refinement refinement = first_edge_split(before);
        in_memory = refined(before, refinement);
        GltfDocument finer = refined(std::move(document), before, refinement);
        in_file = extract_scene(finer);
        save_glb(finer, folder / "finer.glb");
        written = test::read_glb(folder / "finer.glb");
    }

    Json primitive_in() const { return written.json["meshes"][0]["primitives"][0]; }
    Json accessor(const Json& index) const { return written.json["accessors"][index.get<std::size_t>()]; }
    Json accessor(const char* attribute) const { return accessor(primitive_in()["attributes"][attribute]); }
    /// The components of element `i` of an accessor.
    template <class T>
    std::vector<T> element(const Json& index, std::size_t i, std::size_t components) const {
        return test::glb_element<T>(written, index.get<std::size_t>(), i, components);
    }
    template <class T>
    std::vector<T> element(const char* attribute, std::size_t i, std::size_t components) const {
        return element<T>(primitive_in()["attributes"][attribute], i, components);
    }

    test::TemporaryFolder folder;
    Scene in_memory, in_file;
    GlbFile written;
};

Json& primitive_in(GlbFile& file, std::size_t index = 0) {
    return file.json["meshes"][0]["primitives"][index];
}

void set(GlbFile& file, const char* attribute, std::size_t accessor) {
    primitive_in(file)["attributes"][attribute] = accessor;
}

void expect_same(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.vertex_arrays.size(), b.vertex_arrays.size());
    for (std::size_t i = 0; i < a.vertex_arrays.size(); ++i) {
        const VertexArray &x = a.vertex_arrays[i], &y = b.vertex_arrays[i];
        ASSERT_EQ(x.size(), y.size());
        EXPECT_EQ(x.first_receiver, y.first_receiver);
        for (std::size_t v = 0; v < x.size(); ++v) {
            EXPECT_LT(glm::distance(x.positions[v], y.positions[v]), 1e-6f); // roundings of numbers about 1
            EXPECT_LT(glm::distance(x.normals[v], y.normals[v]), 1e-6f);
        }
    }
    ASSERT_EQ(a.primitives.size(), b.primitives.size());
    for (std::size_t p = 0; p < a.primitives.size(); ++p)
        EXPECT_EQ(a.primitives[p].triangles, b.primitives[p].triangles);
}

TEST(RefinedFile, IsTheRefinedScene) {
    const Finer finer(test::triangle_file());
    expect_same(finer.in_memory, finer.in_file);
    EXPECT_EQ(finer.in_file.vertex_arrays[0].size(), 4);
    EXPECT_EQ(finer.element<float>("POSITION", 3, 3), (std::vector<float>{0.5f, 0, 0}));
    EXPECT_EQ(finer.accessor("POSITION")["max"], Json({1.0, 1.0, 0.0}));
}

TEST(RefinedFile, HasUnitNormalsAndTangents) {
    GlbFile file = test::triangle_file();
    set(file, "NORMAL",
        file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}, test::kFloat, "VEC3", 3));
    set(file, "TANGENT",
        file.accessor(std::vector<float>{0, 0, 1, -1, 0, 1, 0, -1, 1, 0, 0, -1}, test::kFloat, "VEC4", 4));
    const Finer finer(file);
    const auto half = std::numbers::sqrt2_v<float> / 2;
    EXPECT_EQ(finer.element<float>("NORMAL", 3, 3), (std::vector<float>{half, half, 0}));
    EXPECT_EQ(finer.element<float>("TANGENT", 3, 4), (std::vector<float>{0, half, half, -1}));
    expect_same(finer.in_memory, finer.in_file);
}

TEST(RefinedFile, UsesTheFirstEndOfOppositeNormals) {
    GlbFile file = test::triangle_file();
    set(file, "NORMAL",
        file.accessor(std::vector<float>{1, 0, 0, -1, 0, 0, 0, 0, 1}, test::kFloat, "VEC3", 3));
    const Finer finer(file);
    EXPECT_EQ(finer.element<float>("NORMAL", 3, 3), (std::vector<float>{1, 0, 0}));
    expect_same(finer.in_memory, finer.in_file);
}

TEST(RefinedFile, KeepsQuantizedTypesExceptPositions) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const auto positions = file.accessor(std::vector<std::int16_t>{0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0},
                                         test::kShort, "VEC3", 4, false, 8);
    file.json["accessors"][positions]["min"] = {0, 0, 0};
    file.json["accessors"][positions]["max"] = {3, 3, 0};
    set(file, "POSITION", positions);
    set(file, "NORMAL",
        file.accessor(std::vector<std::int8_t>{127, 0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0}, test::kByte, "VEC3",
                      4, true, 4));
    set(file, "TEXCOORD_0",
        file.accessor(std::vector<std::uint16_t>{0, 0, 65535, 101, 0, 65535}, test::kUnsignedShort, "VEC2", 2,
                      true));
    set(file, "TEXCOORD_1",
        file.accessor(std::vector<std::uint16_t>{0, 0, 3, 1, 0, 3}, test::kUnsignedShort, "VEC2", 2));
    set(file, "COLOR_0",
        file.accessor(std::vector<std::uint8_t>{0, 10, 20, 255, 255, 20, 30, 255, 0, 0, 0, 255},
                      test::kUnsignedByte, "VEC4", 4, true));
    const Finer finer(file);
    EXPECT_EQ(finer.accessor("POSITION")["componentType"], test::kFloat);
    EXPECT_EQ(finer.element<float>("POSITION", 3, 3), (std::vector<float>{1.5f, 0, 0})); // not 1, nor 2
    EXPECT_EQ(finer.element<std::int8_t>("NORMAL", 3, 3), (std::vector<std::int8_t>{90, 90, 0})); // 127/√2
    EXPECT_EQ(finer.element<std::uint16_t>("TEXCOORD_0", 3, 2), (std::vector<std::uint16_t>{32768, 51}));
    EXPECT_EQ(finer.element<float>("TEXCOORD_1", 3, 2), (std::vector<float>{1.5f, 0.5f}));
    EXPECT_EQ(finer.element<std::uint8_t>("COLOR_0", 3, 4), (std::vector<std::uint8_t>{128, 15, 25, 255}));
    EXPECT_EQ(finer.element<std::uint16_t>("TEXCOORD_0", 1, 2), (std::vector<std::uint16_t>{65535, 101}));
}

TEST(RefinedFile, AveragesFloatAttributesAndCopiesIntegerAttributes) {
    GlbFile file = test::triangle_file();
    set(file, "_HEAT", file.accessor(std::vector<float>{1, 4, 9}, test::kFloat, "SCALAR", 1));
    set(file, "_FEATURE_ID_0",
        file.accessor(std::vector<std::uint16_t>{3, 0, 5, 0, 7, 0}, test::kUnsignedShort, "SCALAR", 2, false,
                      4));
    const Finer finer(file);
    EXPECT_EQ(finer.element<float>("_HEAT", 3, 1), std::vector<float>{2.5f});
    EXPECT_EQ(finer.element<std::uint16_t>("_FEATURE_ID_0", 3, 1), std::vector<std::uint16_t>{3});
}

TEST(RefinedFile, AveragesMorphTargetsIncludingSparseOnes) {
    GlbFile file = test::triangle_file();
    const auto target = file.accessor(std::vector<float>{0, 0, 2, 0, 0, 0, 0, 0, 0}, test::kFloat, "VEC3", 3);
    const std::vector<std::uint8_t> at = {1};
    const std::vector<float> value = {0, 0, 8};
    Json sparse = {{"componentType", test::kFloat}, {"count", 3}, {"type", "VEC3"}};
    sparse["sparse"] = {
        {"count", 1},
        {"indices",
         {{"bufferView", file.view(std::as_bytes(std::span(at)))}, {"componentType", test::kUnsignedByte}}},
        {"values", {{"bufferView", file.view(std::as_bytes(std::span(value)))}}}};
    file.json["accessors"].push_back(sparse);
    primitive_in(file)["targets"] =
        Json::array({{{"POSITION", target}}, {{"POSITION", file.json["accessors"].size() - 1}}});
    file.json["meshes"][0]["weights"] = {0.5, 0.25};
    const Finer finer(file);
    const Json targets = finer.primitive_in()["targets"];
    EXPECT_EQ(finer.element<float>(targets[0]["POSITION"], 3, 3), (std::vector<float>{0, 0, 1}));
    EXPECT_EQ(finer.element<float>(targets[1]["POSITION"], 3, 3), (std::vector<float>{0, 0, 4}));
    EXPECT_FALSE(finer.accessor(targets[1]["POSITION"]).contains("sparse"));
    expect_same(finer.in_memory, finer.in_file); // in the pose of the file, where all is linear
}

/// A triangle at three joints, of which each vertex has four and weights of this type.
template <class Weight>
GlbFile skinned(const std::vector<std::uint8_t>& joints, const std::vector<Weight>& weights,
                int component_type) {
    GlbFile file = test::triangle_file();
    set(file, "JOINTS_0", file.accessor(joints, test::kUnsignedByte, "VEC4", 4));
    set(file, "WEIGHTS_0", file.accessor(weights, component_type, "VEC4", 4, component_type != test::kFloat));
    file.json["nodes"][0]["skin"] = 0;
    for (std::size_t j = 1; j <= 9; ++j) {
        file.json["skins"][0]["joints"].push_back(j);
        file.json["nodes"][j]["translation"] = std::vector<double>{0, 0, static_cast<double>(j - 1)};
        file.json["scenes"][0]["nodes"].push_back(j);
    }
    return file;
}

TEST(RefinedFile, HasTheJointsOfBothEndsAndTheHeaviestFourOfThem) {
    const Finer few(skinned<float>({1, 2, 0, 0, 2, 3, 0, 0, 1, 0, 0, 0},
                                   {0.5f, 0.5f, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0}, test::kFloat));
    EXPECT_EQ(few.element<std::uint8_t>("JOINTS_0", 3, 4), (std::vector<std::uint8_t>{2, 3, 1, 0}));
    EXPECT_EQ(few.element<float>("WEIGHTS_0", 3, 4), (std::vector<float>{0.375f, 0.375f, 0.25f, 0}));
    const Finer many(skinned<float>({1, 2, 3, 4, 5, 6, 7, 8, 1, 0, 0, 0},
                                    {0.4f, 0.3f, 0.2f, 0.1f, 0.45f, 0.35f, 0.15f, 0.05f, 1, 0, 0, 0},
                                    test::kFloat));
    EXPECT_EQ(many.element<std::uint8_t>("JOINTS_0", 3, 4), (std::vector<std::uint8_t>{5, 1, 6, 2}));
    const std::vector<float> weights = many.element<float>("WEIGHTS_0", 3, 4);
    EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-6);
    EXPECT_NEAR(weights[0], 0.45 / 1.5, 1e-6);
}

TEST(RefinedFile, IntegerWeightsSumToOne) {
    const Finer finer(skinned<std::uint8_t>({1, 2, 3, 0, 4, 5, 6, 0, 1, 0, 0, 0},
                                            {85, 85, 85, 0, 85, 85, 85, 0, 255, 0, 0, 0},
                                            test::kUnsignedByte));
    int sum = 0;
    for (const std::uint8_t w : finer.element<std::uint8_t>("WEIGHTS_0", 3, 4))
        sum += w;
    EXPECT_EQ(sum, 255);
}

TEST(RefinedFile, KeepsVerticesWithoutWeights) {
    const Finer finer(
        skinned<float>(std::vector<std::uint8_t>(12, 0), std::vector<float>(12, 0), test::kFloat));
    EXPECT_EQ(finer.element<float>("WEIGHTS_0", 3, 4), std::vector<float>(4, 0));
}

TEST(RefinedFile, SplitsStripsAndMirroredTriangles) {
    GlbFile file = test::triangle_file();
    primitive_in(file)["mode"] = 5;
    file.json["nodes"][0]["scale"] = {-1, 1, 1}; // the scene reverses the winding
    const Finer finer(file);
    ASSERT_TRUE(finer.in_file.primitives[0].mirrored);
    EXPECT_FALSE(finer.primitive_in().contains("mode"));
    expect_same(finer.in_memory, finer.in_file);
    EXPECT_EQ(finer.element<std::uint32_t>(finer.primitive_in()["indices"], 0, 3),
              (std::vector<std::uint32_t>{0, 1, 3})); // in the order of the file: 0 1 2 without the middle 3
}

TEST(RefinedFile, KeepsFlatNormalsOfPrimitivesWithoutAny) {
    GlbFile file = test::triangle_file();
    primitive_in(file)["attributes"].erase("NORMAL");
    const Finer finer(file);
    EXPECT_EQ(finer.element<float>("NORMAL", 3, 3), (std::vector<float>{0, 0, 1}));
    EXPECT_EQ(finer.in_file.vertex_arrays[0].size(), 4); // not split by roundings
    EXPECT_TRUE(finer.in_file.vertex_arrays[0].source.empty());
}

TEST(RefinedFile, IsRefinedSeparatelyForEachNode) {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    const Finer finer(file); // only node 0
    ASSERT_EQ(finer.in_file.primitives.size(), 2);
    EXPECT_EQ(finer.in_file.primitives[0].triangles.size(), 2);
    EXPECT_EQ(finer.in_file.primitives[1].triangles.size(), 1);
    expect_same(finer.in_memory, finer.in_file);
}

TEST(RefinedFile, SharesVerticesOfSeveralPrimitivesAndKeepsPoints) {
    GlbFile file = test::triangle_file();
    primitive_in(file)["extras"] = {{"kept", true}};
    file.json["meshes"][0]["primitives"].push_back(primitive_in(file));
    file.json["meshes"][0]["primitives"].push_back(
        Json{{"attributes", {{"POSITION", primitive_in(file)["attributes"]["POSITION"]}}}, {"mode", 0}});
    const Finer finer(file);
    const Json primitives = finer.written.json["meshes"][0]["primitives"];
    EXPECT_EQ(primitives[0]["attributes"], primitives[1]["attributes"]);
    EXPECT_EQ(primitives[1]["extras"], Json({{"kept", true}}));
    EXPECT_EQ(finer.accessor(primitives[2]["attributes"]["POSITION"])["count"], 3);
    expect_same(finer.in_memory, finer.in_file);
}

TEST(RefinedFile, HasNoTransferAndKeepsNotices) {
    test::TemporaryFolder folder;
    test::triangle_file().write(folder / "file.glb");
    GltfDocument document = load_gltf(folder / "file.glb");
    const Scene scene = extract_scene(document);
    BakedTransfer baked;
    baked.transfer = zero_transfer(2, 1, scene.receivers());
    write_transfer(document, scene, baked);
    const std::vector<std::byte> bytes = encode_glb(document);
    GltfDocument finer = refined(parse_gltf(bytes, "baked.glb"), scene, first_edge_split(scene));
    const Scene finer_scene = extract_scene(finer);
    EXPECT_FALSE(read_transfer(finer, finer_scene));
}

} // namespace
} // namespace prt
