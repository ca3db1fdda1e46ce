// Tests materials, nodes and textures beyond the core of glTF, and notices about unsupported ones.

#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

using test::GlbFile;

GltfDocument document_of(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
}

Scene parsed(const GlbFile& file) {
    return extract_scene(document_of(file));
}

/// A triangle with that material.
GlbFile with_material(const nlohmann::ordered_json& material) {
    GlbFile file = test::triangle_file();
    file.json["materials"] = nlohmann::ordered_json::array({material});
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

Material only_material(const nlohmann::ordered_json& material) {
    return parsed(with_material(material)).materials.at(0);
}

std::size_t notices_with(const Scene& scene, const char* text) {
    return static_cast<std::size_t>(
        std::count_if(scene.notices.begin(), scene.notices.end(),
                      [&](const std::string& notice) { return notice.find(text) != std::string::npos; }));
}

TEST(Clamped, ValuesOutsideTheirRangeCauseOneNotice) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    GlbFile file = with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {1.2, -0.5, 0.25, 7}}, {"metallicFactor", -2}, {"roughnessFactor", 1.5}}},
         {"extensions",
          {{"KHR_materials_diffuse_transmission",
            {{"diffuseTransmissionFactor", 4}, {"diffuseTransmissionColorFactor", {2, 0.5, -1}}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 1e30}}}}}});
    file.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", {9, 0, 0, 1}}}}});
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        file.accessor(std::vector<float>{1.2f, 0.5f, nan, 1, 0, 1, -3, 1, 0.1f, infinity, 0.2f, 2},
                      test::kFloat, "VEC4", 4);
    const Scene scene = parsed(file);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.base_color, glm::vec4(1, 0, 0.25f, 1));
    EXPECT_EQ(m.metal.factor, 0);
    EXPECT_EQ(m.metal.roughness, 1);
    EXPECT_EQ(m.transmission.factor, 1);
    EXPECT_EQ(m.transmission.color, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(m.glass.factor, 1);
    const std::vector<glm::vec4> colors = {{1, 0.5f, 0, 1}, {0, 1, 0, 1}, {0.1f, 1, 0.2f, 1}};
    EXPECT_EQ(scene.vertex_arrays[0].colors, colors);
    ASSERT_EQ(scene.notices.size(), 1u);
    EXPECT_NE(scene.notices[0].find("baseColorFactor of materials (2)"), std::string::npos);
    EXPECT_NE(scene.notices[0].find("COLOR_0 of vertices (3)"), std::string::npos);
    EXPECT_TRUE(parsed(with_material({{"name", "fine"}})).notices.empty());
}

TEST(SpecularGlossiness, UsesItsDiffuseColorWithoutMetal) {
    GlbFile file =
        with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 1, 1}}, {"metallicFactor", 1}}},
                       {"extensions",
                        {{"KHR_materials_pbrSpecularGlossiness",
                          {{"diffuseFactor", {0.8, 0.4, 0.2, 0.5}},
                           {"diffuseTexture", {{"index", 0}, {"texCoord", 1}}}}}}}});
    file.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
    file.json["images"] = {
        {{"bufferView", file.view(std::as_bytes(std::span("abcd")))}, {"mimeType", "image/png"}}};
    file.json["textures"] = {{{"source", 0}}};
    const Material m = parsed(file).materials.at(0);
    EXPECT_EQ(m.base_color, glm::vec4(0.8f, 0.4f, 0.2f, 0.5f));
    EXPECT_EQ(m.base_color_texture.image, 0);
    EXPECT_EQ(m.base_color_texture.texcoord, 1);
    EXPECT_EQ(m.metal.factor, 0);
}

TEST(Metal, UsesTheFactorsOfTheFileOrTheDefaults) {
    const Material m =
        only_material({{"pbrMetallicRoughness", {{"metallicFactor", 0.75}, {"roughnessFactor", 0.25}}}});
    EXPECT_EQ(m.metal.factor, 0.75f);
    EXPECT_EQ(m.metal.roughness, 0.25f);
    const Material unsaid = only_material({{"name", "plain"}}); // glTF's default
    EXPECT_EQ(unsaid.metal.factor, 1);
    EXPECT_EQ(unsaid.metal.roughness, 1);
}

TEST(Glass, MetallicFactorDisablesTransmission) {
    const auto factor = [](double metallic) {
        return only_material(
                   {{"pbrMetallicRoughness", {{"metallicFactor", metallic}}},
                    {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.8}}}}}})
            .glass.factor;
    };
    EXPECT_FLOAT_EQ(factor(0), 0.8f);
    EXPECT_FLOAT_EQ(factor(0.5), 0.4f);
    EXPECT_FLOAT_EQ(factor(1), 0);
}

TEST(Unread, NormalMapsAreReportedOnceIfUsed) {
    const nlohmann::ordered_json special = {{"normalTexture", {{"index", 0}}}};
    GlbFile file = with_material(special);
    file.json["materials"].push_back(special);
    file.json["materials"].push_back(special); // which nobody uses
    auto second = file.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(second);
    file.json["images"] = {
        {{"bufferView", file.view(std::as_bytes(std::span("abcd")))}, {"mimeType", "image/png"}}};
    file.json["textures"] = {{{"source", 0}}};
    const Scene scene = parsed(file);
    EXPECT_EQ(notices_with(scene, "2 materials have normal maps"), 1u);
    EXPECT_EQ(scene.notices.size(), 1u);
}

TEST(Textures, UnknownFormatsAndMissingImagesFailOnlyOnUse) {
    GlbFile file = with_material(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}}});
    file.json["extensionsRequired"] = {"KHR_texture_basisu"};
    const std::string ktx = "\xABKTX 20\xBB\r\n\x1A\n and so on";
    file.json["images"] = {
        {{"mimeType", "image/ktx2"}, {"bufferView", file.view(std::as_bytes(std::span(ktx)))}}};
    file.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}},
                             nlohmann::ordered_json::object()};
    const Scene scene = parsed(file);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.base_color_texture.image, 0);
    ASSERT_EQ(m.metal.texture.image, 1);
    EXPECT_TRUE(scene.images[1].bytes.empty());
    EXPECT_EQ(scene.images[1].name, "the image of texture 1");
}

TEST(Hidden, NodesAndTheirDescendantsAreExcluded) {
    GlbFile file = test::triangle_file();
    const nlohmann::ordered_json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}},
                          {{"children", {2, 3}}, {"extensions", hidden}},
                          {{"mesh", 0}, {"translation", {2, 0, 0}}},
                          {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}},
                          {{"mesh", 0}, {"extensions", hidden}},
                          {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 4, 5};
    file.json["extensionsRequired"] = {"KHR_node_visibility"};
    const Scene scene = parsed(file);
    ASSERT_EQ(scene.primitives.size(), 2u);
    EXPECT_EQ(scene.primitives[0].node, 0);
    EXPECT_EQ(scene.primitives[1].node, 5);
    EXPECT_EQ(notices_with(scene, "3 hidden meshes are ignored"), 1u);
}

/// Returns three instances of the triangle, moved, rotated and scaled, below a node that moves all up.
GlbFile three_instances() {
    GlbFile file = test::triangle_file();
    const auto half = static_cast<std::int16_t>(std::lround(32767 * std::sqrt(0.5)));
    const auto translation =
        file.accessor(std::vector<float>{0, 0, 0, 5, 0, 0, 0, 0, -7}, test::kFloat, "VEC3", 3);
    const auto rotation = // none, then a quarter rotation about z
        file.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, half, half, 0, 0, 0, 32767},
                      test::kShort, "VEC4", 4, true);
    const auto scale =
        file.accessor(std::vector<float>{1, 1, 1, 2, 3, 1, 0.5, 1, 1}, test::kFloat, "VEC3", 3);
    file.json["nodes"] = {
        {{"mesh", 0},
         {"name", "many"},
         {"translation", {0, 10, 0}},
         {"children", {1}},
         {"extensions",
          {{"EXT_mesh_gpu_instancing",
            {{"attributes", {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}}}}}}}},
        {{"mesh", 0}, {"translation", {0, 0, 100}}}};
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    return file;
}

TEST(Instances, AreSeparateNodesInTheScene) {
    const Scene scene = parsed(three_instances());
    ASSERT_EQ(scene.primitives.size(), 4u); // the child is there once
    const auto corner = [&](std::size_t primitive, std::size_t vertex) {
        return glm::vec3(
            scene.world(scene.vertex_arrays[scene.primitives[primitive].vertices].positions[vertex]));
    };
    std::vector<glm::vec3> corners;
    for (std::size_t p = 0; p < 4; ++p)
        corners.push_back(corner(p, 1)); // (1, 0, 0)
    const auto has = [&](const glm::vec3& expected) {
        return std::any_of(corners.begin(), corners.end(),
                           [&](const glm::vec3& c) { return glm::distance(c, expected) < 1e-3f; });
    };
    EXPECT_TRUE(has({1, 10, 0}));
    EXPECT_TRUE(has({5, 12, 0})); // scaled to 2, rotated to +y, moved
    EXPECT_TRUE(has({0.5f, 10, -7}));
    EXPECT_TRUE(has({1, 10, 100}));
    EXPECT_EQ(notices_with(scene, "3 instances of EXT_mesh_gpu_instancing"), 1u);
}

TEST(Instances, KeepSeparateTransferInTheFile) {
    GltfDocument document = document_of(three_instances());
    const Scene scene = extract_scene(document);
    BakedTransfer baked;
    baked.transfer = zero_transfer(2, 1, scene.receivers());
    for (std::size_t i = 0; i < baked.transfer.vectors.size(); ++i)
        baked.transfer.vectors[i] = static_cast<float>(i);
    write_transfer(document, scene, baked);
    const test::TemporaryFolder folder;
    save_glb(document, folder / "baked.glb");
    const GltfDocument read = load_gltf(folder / "baked.glb");
    const Scene again = extract_scene(read);
    ASSERT_EQ(again.receivers(), scene.receivers());
    for (std::size_t a = 0; a < scene.vertex_arrays.size(); ++a)
        EXPECT_EQ(again.vertex_arrays[a].positions, scene.vertex_arrays[a].positions);
    EXPECT_EQ(read_transfer(read, again)->transfer.vectors, baked.transfer.vectors);
}

TEST(Instances, MismatchesAreRejected) {
    const auto message = [](const auto& change) -> std::string {
        GlbFile file = three_instances();
        change(file, file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]);
        try {
            parsed(file);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message([](GlbFile& file, auto& attributes) {
                  attributes["SCALE"] = file.accessor(std::vector<float>(6, 1), test::kFloat, "VEC3", 3);
              }).find("memory.glb: node 0: the attributes of its instances have different numbers"),
              std::string::npos);
    EXPECT_NE(message([](GlbFile&, auto& attributes) { attributes["SCALE"] = 99; }).find("accessor 99"),
              std::string::npos);
    EXPECT_NE(message([](GlbFile& file, auto& attributes) {
                  attributes = {{"TRANSLATION", file.json["accessors"].size()}};
                  file.json["accessors"].push_back(
                      {{"componentType", test::kFloat}, {"count", 2'000'000}, {"type", "VEC3"}});
              }).find("2000000 instances"),
              std::string::npos);
}

} // namespace
} // namespace prt
