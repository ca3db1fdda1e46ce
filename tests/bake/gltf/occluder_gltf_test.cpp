// Rigid parts of scenes, and occlusion volumes of nodes in files.

#include "bake/gltf/encode_glb.h"
#include "bake/gltf/rigid_parts.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/glb_file.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace prt {
namespace occluders_of_files { // joined sources share one scope
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

GltfDocument parsed(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
}

std::vector<RigidPart> terms_of(const GlbFile& file, double least = 0) {
    const GltfDocument document = parsed(file);
    return rigid_parts(document, extract_scene(document), {.min_share = least});
}

/// A chain of three nodes with a triangle each, the root at the origin, each a metre above the one before.
GlbFile chain() {
    GlbFile file = test::triangle_file();
    file.json["nodes"] =
        Json::array({{{"name", "root"}, {"mesh", 0}, {"children", {1}}},
                     {{"name", "arm"}, {"mesh", 0}, {"children", {2}}, {"translation", {0, 1, 0}}},
                     {{"name", "hand"}, {"mesh", 0}, {"translation", {0, 1, 0}}}});
    file.json["scenes"] = Json::array({{{"nodes", {0}}}});
    return file;
}

/// Adds an animation that rotates a node.
void rotation(GlbFile& file, int node) {
    const std::size_t times = file.accessor(std::vector<float>{0, 1}, test::kFloat, "SCALAR", 1);
    file.json["accessors"][times]["min"] = {0};
    file.json["accessors"][times]["max"] = {1};
    const std::size_t rotations =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}, test::kFloat, "VEC4", 4);
    file.json["animations"].push_back(
        {{"samplers", {{{"input", times}, {"output", rotations}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}}}}});
}

std::vector<std::string> names_of(const std::vector<RigidPart>& parts) {
    std::vector<std::string> names;
    for (const RigidPart& part : parts)
        names.push_back(part.name);
    return names;
}

TEST(RigidParts, StaticNodesFormRootParts) {
    EXPECT_EQ(names_of(terms_of(chain())), (std::vector<std::string>{"root"}));
    EXPECT_EQ(terms_of(chain())[0].scene.triangles(), 3u);
}

/// Each of them once: 12 500 parts of 12 500 materials took 22 GB.
TEST(RigidParts, ContainTheirMaterialsAndImages) {
    GlbFile file = test::triangle_file();
    file.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}, {{"uri", "c.png"}}};
    file.json["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
    const Json primitive = file.json["meshes"][0]["primitives"][0];
    file.json["meshes"] = file.json["nodes"] = Json::array();
    for (int i = 0; i < 3; ++i) {
        file.json["materials"].push_back({{"name", std::to_string(i)},
                                          {"alphaMode", i == 1 ? "MASK" : "OPAQUE"},
                                          {"doubleSided", i == 2},
                                          {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
        file.json["meshes"].push_back({{"primitives", {primitive, primitive}}});
        for (Json& part : file.json["meshes"].back()["primitives"])
            part["material"] = i;
        file.json["nodes"].push_back({{"mesh", i}});
    }
    file.json["scenes"] = Json::array({{{"nodes", {0, 1, 2}}}});
    const std::vector<RigidPart> parts = terms_of(file);
    ASSERT_EQ(parts.size(), 3u);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Scene& scene = parts[i].scene;
        ASSERT_EQ(scene.materials.size(), 1u);
        for (const Primitive& of_part : scene.primitives)
            EXPECT_EQ(of_part.material, 0u);
        EXPECT_EQ(scene.materials[0].double_sided, i == 2);
        EXPECT_EQ(scene.images.size(), i == 1 ? 1u : 0u);
        EXPECT_EQ(scene.materials[0].base_color_texture.image, i == 1 ? 0 : -1);
    }
    EXPECT_NE(parts[1].scene.images[0].name.find("b.png"), std::string::npos);
}

TEST(RigidParts, BeginAtMovingNodes) {
    GlbFile file = chain();
    rotation(file, 1);
    const std::vector<RigidPart> parts = terms_of(file);
    ASSERT_EQ(names_of(parts), (std::vector<std::string>{"root", "arm"}));
    EXPECT_EQ(parts[0].scene.triangles(), 1u);
    EXPECT_EQ(parts[1].scene.triangles(), 2u);
}

TEST(RigidParts, AreInTheSpaceOfTheirNode) {
    GlbFile file = chain();
    rotation(file, 1);
    const RigidPart arm = terms_of(file)[1];
    const glm::dmat4 back = glm::inverse(arm.frame);
    float least = 1e9f;
    for (const VertexArray& vertices : arm.scene.vertex_arrays)
        for (const glm::vec3& v : vertices.positions)
            least = std::min(least, static_cast<float>((back * glm::dvec4(v, 1)).y));
    EXPECT_NEAR(least, 0, 1e-6); // the arm's own triangle begins where its node is
}

TEST(RigidParts, SmallPartsJoinTheirParents) {
    GlbFile file = chain();
    rotation(file, 1);
    rotation(file, 2);
    EXPECT_EQ(terms_of(file).size(), 3u);
    // Every triangle has a diagonal of 1.41, two of 2.24, the whole one of 3.16.
    EXPECT_EQ(names_of(terms_of(file, 0.5)), (std::vector<std::string>{"root", "arm"}));
    EXPECT_EQ(names_of(terms_of(file, 0.8)), (std::vector<std::string>{"root"}));
}

/// Returns two triangles, each skinned to a separate joint; one of the joints is a metre up.
GlbFile skinned() {
    GlbFile file = test::triangle_file();
    file.binary.clear();
    for (const char* name : {"accessors", "bufferViews"})
        file.json[name] = Json::array();
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0,
                                              0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    std::vector<float> weights;
    for (int v = 0; v < 6; ++v)
        for (const float w : {v < 3 ? 0.9f : 0.2f, v < 3 ? 0.1f : 0.8f, 0.0f, 0.0f})
            weights.push_back(w);
    const std::vector<std::uint16_t> indices = {0, 1, 2, 3, 4, 5};
    Json primitive = {{"attributes",
                       {{"POSITION", file.accessor(positions, test::kFloat, "VEC3", 3)},
                        {"NORMAL", file.accessor(normals, test::kFloat, "VEC3", 3)},
                        {"JOINTS_0", file.accessor(joints, test::kUnsignedByte, "VEC4", 4)},
                        {"WEIGHTS_0", file.accessor(weights, test::kFloat, "VEC4", 4)}}},
                      {"indices", file.accessor(indices, test::kUnsignedShort, "SCALAR", 1)}};
    file.json["accessors"][0]["min"] = {0, 0, 0};
    file.json["accessors"][0]["max"] = {1, 2, 0};
    file.json["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
    file.json["skins"] = Json::array({{{"joints", {1, 2}}}});
    file.json["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}},
                                      {{"name", "hip"}, {"children", {2}}},
                                      {{"name", "head"}, {"translation", {0, 1, 0}}}});
    file.json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
    return file;
}

TEST(RigidParts, FollowTheDominantJointsOfSkins) {
    const std::vector<RigidPart> parts = terms_of(skinned());
    ASSERT_EQ(names_of(parts), (std::vector<std::string>{"hip", "head"}));
    EXPECT_EQ(parts[0].scene.triangles(), 1u);
    EXPECT_EQ(parts[1].scene.triangles(), 1u);
    EXPECT_EQ(parts[1].node, 2);
}

DetailedParts detailed(const GlbFile& file, const GlbFile& finer) {
    const GltfDocument document = parsed(file), high_poly = parsed(finer);
    return detailed_parts(document, extract_scene(document), high_poly, extract_scene(high_poly), {0});
}

/// Nodes without a name of the scene belong to the part of their parent, and a name to the part of its node.
TEST(RigidParts, TakeTrianglesOfAHighPolyModel) {
    GlbFile file = chain(), finer = chain();
    rotation(file, 1); // the arm takes the hand with it
    finer.json["nodes"][2]["name"] = "nail";
    finer.json["nodes"].push_back({{"name", "hand"}, {"mesh", 0}, {"translation", {5, 0, 0}}});
    finer.json["nodes"].push_back({{"name", "other"}, {"mesh", 0}});
    finer.json["scenes"][0]["nodes"] = {0, 3, 4};
    const DetailedParts both = detailed(file, finer);
    ASSERT_EQ(names_of(both.parts), (std::vector<std::string>{"root", "arm"}));
    EXPECT_EQ(both.parts[0].scene.triangles(), 1u);
    EXPECT_EQ(both.parts[1].scene.triangles(), 3u);
    EXPECT_FLOAT_EQ(bounds(both.parts[1].scene).high.x, 6 - static_cast<float>(both.parts[1].scene.origin.x));
    EXPECT_EQ(both.parts[1].frame, terms_of(file)[1].frame);
    EXPECT_EQ(both.scene.triangles(), 4u);
    EXPECT_EQ(both.unused, 1u);
    EXPECT_TRUE(both.own.empty());
    finer.json["scenes"][0]["nodes"] = {3};
    EXPECT_EQ(detailed(file, finer).own, std::vector<std::string>{"root"});
    EXPECT_EQ(detailed(file, finer).scene.triangles(), 2u);
    finer.json["scenes"][0]["nodes"] = {4};
    EXPECT_THROW(detailed(file, finer), Error);
    file.json["nodes"][0]["name"] = "arm";
    EXPECT_THROW(detailed(file, chain()), Error); // two nodes have this name
}

TEST(RigidParts, TakeTrianglesOfSkinsOfAHighPolyModel) {
    const DetailedParts parts = detailed(skinned(), skinned());
    ASSERT_EQ(parts.parts.size(), 2u);
    for (const RigidPart& part : parts.parts)
        EXPECT_EQ(part.scene.triangles(), 1u);
    EXPECT_TRUE(parts.own.empty());
}

OcclusionVolume any_volume(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> any(-127, 127);
    OcclusionVolume volume{{-1, -2, -3}, {4, 5, 6}, 20, {}};
    for (OccluderTexel& texel : volume.texels)
        for (std::int8_t& n : texel)
            n = static_cast<std::int8_t>(any(random));
    return volume;
}

GlbFile with_occluders() {
    GltfDocument document = parsed(chain());
    const NodeOccluder occluders[] = {{0, any_volume(1)}, {2, any_volume(2)}};
    write_occluders(document, occluders);
    return test::glb_of(encode_glb(document));
}

TEST(Occluders, RoundTrip) {
    const std::vector<NodeOccluder> read = read_occluders(parsed(with_occluders()));
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].node, 0);
    EXPECT_EQ(read[1].node, 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const OcclusionVolume expected = any_volume(static_cast<std::uint32_t>(i + 1));
        EXPECT_EQ(read[i].volume.texels, expected.texels);
        EXPECT_EQ(read[i].volume.low, expected.low);
        EXPECT_EQ(read[i].volume.high, expected.high);
        EXPECT_EQ(read[i].volume.reach, expected.reach);
    }
}

TEST(Occluders, AreReplaced) {
    GltfDocument document = parsed(with_occluders());
    const std::size_t before = encode_glb(document).size();
    const NodeOccluder one[] = {{1, any_volume(3)}};
    write_occluders(document, one);
    const std::vector<std::byte> bytes = encode_glb(document);
    EXPECT_LT(bytes.size(), before);
    ASSERT_EQ(read_occluders(document).size(), 1u);
    write_occluders(document, {});
    EXPECT_TRUE(read_occluders(document).empty());
    EXPECT_FALSE(test::glb_of(encode_glb(document)).json.contains("extensionsUsed"));
}

std::string error_of(const GlbFile& file) {
    try {
        read_occluders(parsed(file));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Occluders, DamageIsRejectedWithItsNode) {
    const auto damaged = [](const char* member, const Json& value) {
        GlbFile file = with_occluders();
        file.json["nodes"][2]["extensions"]["PRTKIT_occlusion_volume"][member] = value;
        return error_of(file);
    };
    EXPECT_NE(damaged("version", 9).find("node 2: PRTKIT_occlusion_volume has version 9"), std::string::npos);
    EXPECT_NE(damaged("min", {1, 2}).find("min of an occlusion volume"), std::string::npos);
    EXPECT_NE(damaged("max", {-5, 5, 6}).find("is empty or not finite"), std::string::npos);
    EXPECT_NE(damaged("reach", -1).find("reach"), std::string::npos);
    EXPECT_NE(damaged("reach", "far").find("node 2"), std::string::npos);
    EXPECT_NE(damaged("texels", {{"bufferView", 0}}).find("bytes of texels, but must have 2048"),
              std::string::npos);
    EXPECT_NE(damaged("texels", {{"bufferView", 4711}}).find("4711"), std::string::npos);
    EXPECT_NE(damaged("texels", Json::object()).find("node 2"), std::string::npos);
}

} // namespace
} // namespace occluders_of_files
} // namespace prt
