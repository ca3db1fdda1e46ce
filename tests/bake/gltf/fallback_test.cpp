// Tests baked light for viewers that do not support the extensions: its colors, and that other readers ignore
// it.

#include "bake/gltf/vertex_fallback.h"

#include "bake/gltf/encode_glb.h"
#include "prt/core/error.h"
#include "support/glb_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

constexpr float kExposure = 0.5f;

GltfDocument document_of(const GlbFile& file) {
    const std::string text = file.bytes();
    return parse_gltf(std::as_bytes(std::span(text)), "model.glb");
}

/// Returns primitives of material 0, with colors and without, of an emissive material and without material;
/// and points of material 0, which have no transfer.
GlbFile scene_of_all_kinds() {
    GlbFile file = test::triangle_file();
    file.json["materials"] = {
        {{"name", "wall"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}},
        {{"name", "lamp"}, {"emissiveFactor", {1, 0, 0}}},
        {{"name", "sign"}, {"extensions", {{"KHR_materials_unlit", Json::object()}}}}};
    file.json["extensionsUsed"] = {"KHR_materials_unlit"};
    Json& primitives = file.json["meshes"][0]["primitives"];
    const Json plain = primitives[0];
    const auto add = [&](int material) -> Json& {
        primitives.push_back(plain);
        if (material >= 0)
            primitives.back()["material"] = material;
        return primitives.back();
    };
    primitives[0]["material"] = 0;
    primitives[0]["attributes"]["COLOR_0"] =
        file.accessor(std::vector<float>{1, 1, 1, 0.5f, 0.5f, 0.5f, 0, 0.25f, 1}, test::kFloat, "VEC3", 3);
    add(0), add(1), add(2), add(-1);
    add(0)["mode"] = 0;
    return file;
}

/// Vertex p of each primitive has radiance weight(p) under `light`.
CompressedTransfer made_up_transfer(const Scene& scene) {
    CompressedTransfer compressed;
    ClusteredTransfer& transfer = compressed.transfer;
    transfer.bases.layout = layout_of_one(1, 1);
    transfer.bases.components = {1};
    transfer.bases.rows = {0, 1};
    transfer.receivers.components = 4;
    transfer.receivers.clusters.resize(scene.receivers());
    std::vector<float> weights(4 * scene.receivers());
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        weights[4 * p] = p % 5 == 4 ? -0.9f : 0.25f * static_cast<float>(p % 5);
    const auto bytes = std::as_bytes(std::span(weights));
    transfer.receivers.weights.assign(bytes.begin(), bytes.end());
    return compressed;
}

GlbFile shipped(const GlbFile& file) {
    GltfDocument document = document_of(file);
    const Scene scene = extract_scene(document);
    write_clustered(document, scene, made_up_transfer(scene));
    return test::glb_of(encode_glb(document));
}

std::vector<glm::vec3> light_of(const GltfDocument& document, const Scene& scene) {
    return exit_radiance(read_clustered(document, scene)->transfer, constant_light(1, {6, 3, 1}), 1);
}

GlbFile with_fallback(const GlbFile& file, std::size_t* count = nullptr) {
    GltfDocument document = document_of(file);
    const Scene scene = extract_scene(document);
    const std::size_t written = write_fallback(document, scene, light_of(document, scene), kExposure);
    if (count)
        *count = written;
    return test::glb_of(encode_glb(document));
}

std::vector<glm::vec4> colors_of(const GlbFile& file, const Json& primitive) {
    const Json& accessor = file.json["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], test::kUnsignedShort);
    EXPECT_EQ(accessor["normalized"], true);
    const Json& view = file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<std::uint16_t> values(4 * accessor["count"].get<std::size_t>());
    std::memcpy(values.data(), &file.binary[view["byteOffset"].get<std::size_t>()], 2 * values.size());
    std::vector<glm::vec4> colors;
    for (std::size_t i = 0; i < values.size(); i += 4)
        colors.push_back(glm::vec4(values[i], values[i + 1], values[i + 2], values[i + 3]) / 65535.0f);
    return colors;
}

bool is_unlit(const GlbFile& file, const Json& primitive) {
    return primitive.contains("material") && file.json["materials"][primitive["material"].get<std::size_t>()]
                                                 .value("extensions", Json::object())
                                                 .contains("KHR_materials_unlit");
}

TEST(Fallback, ShowsLightOnReflectingMaterials) {
    std::size_t count = 0;
    const GlbFile file = with_fallback(shipped(scene_of_all_kinds()), &count);
    EXPECT_EQ(count, 3u);
    const Json& primitives = file.json["meshes"][0]["primitives"];
    const bool unlit[] = {true, true, false, true, true, false};
    for (std::size_t p = 0; p < 6; ++p)
        EXPECT_EQ(is_unlit(file, primitives[p]), unlit[p]) << p;
    EXPECT_EQ(primitives[2]["material"], 1);
    EXPECT_EQ(primitives[3]["material"], 2); // unchanged
    EXPECT_FALSE(primitives[3]["attributes"].contains("COLOR_0"));
    EXPECT_EQ(primitives[5]["material"], 0); // the others have a copy of it
    EXPECT_EQ(primitives[0]["material"], primitives[1]["material"]);
    EXPECT_EQ(file.json["materials"][primitives[0]["material"].get<std::size_t>()]["name"], "wall");

    const GltfDocument document = document_of(shipped(scene_of_all_kinds()));
    const Scene scene = extract_scene(document);
    const std::vector<glm::vec3> light = light_of(document, scene);
    for (const std::size_t p : {0u, 1u, 4u}) {
        const VertexArray& vertices = scene.vertex_arrays[scene.primitives[p].vertices];
        const std::vector<glm::vec4> colors = colors_of(file, primitives[p]);
        ASSERT_EQ(colors.size(), vertices.size());
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (int c = 0; c < 4; ++c) {
                const float own = vertices.colors.empty() ? 1 : vertices.colors[v][c];
                const float shown = c == 3 ? own : own * kExposure * light[vertices.first_receiver + v][c];
                EXPECT_NEAR(colors[v][c], std::clamp(shown, 0.0f, 1.0f), 1e-5) << p << " " << v << " " << c;
            }
    }
}

TEST(Fallback, IsIgnoredByReadersOfTransfer) {
    const GlbFile before = shipped(scene_of_all_kinds());
    const GltfDocument plain = document_of(before), document = document_of(with_fallback(before));
    const Scene expected = extract_scene(plain), scene = extract_scene(document);
    ASSERT_EQ(scene.primitives.size(), expected.primitives.size());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const VertexArray &vertices = scene.vertex_arrays[scene.primitives[p].vertices],
                          &own = expected.vertex_arrays[expected.primitives[p].vertices];
        EXPECT_EQ(vertices.colors, own.colors) << p;
        const Material &material = scene.materials[scene.primitives[p].material],
                       &same = expected.materials[expected.primitives[p].material];
        EXPECT_EQ(material.base_color, same.base_color) << p;
        EXPECT_EQ(material.emission.radiance, same.emission.radiance) << p;
    }
    EXPECT_EQ(light_of(document, scene), light_of(plain, expected));
}

TEST(Fallback, IsRemovedWithTheTransfer) {
    GltfDocument document = document_of(with_fallback(shipped(scene_of_all_kinds())));
    discard_transfer(document);
    const GlbFile file = test::glb_of(encode_glb(document));
    const std::string text = file.json.dump();
    for (const char* word : {"PRT", "fallback"})
        EXPECT_EQ(text.find(word), std::string::npos) << word;
    EXPECT_EQ(file.json["extensionsUsed"], Json({"KHR_materials_unlit"})); // used by the sign
    EXPECT_TRUE(file.json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
    EXPECT_FALSE(file.json["meshes"][0]["primitives"][1]["attributes"].contains("COLOR_0"));
    GltfDocument plain = document_of(shipped(scene_of_all_kinds()));
    discard_transfer(plain);
    EXPECT_EQ(file.binary, test::glb_of(encode_glb(plain)).binary);
}

TEST(Fallback, DamageIsRejectedOrIgnored) {
    const GlbFile right = with_fallback(shipped(scene_of_all_kinds()));
    for (const Json& exposure : {Json(0), Json(-1), Json("bright"), Json(nullptr)}) {
        GlbFile file = right;
        test::set_of(file.json, "vertices")["fallback"]["exposure"] = exposure;
        EXPECT_THROW(document_of(file), Error) << exposure;
    }
    GlbFile file = right;
    for (const Json& extras : {Json(7), Json({{"prtkit", 7}}), Json::array({1})}) {
        for (Json& material : file.json["materials"])
            material["extensions"]["KHR_materials_unlit"] = {{"extras", extras}};
        EXPECT_EQ(extract_scene(document_of(file)).primitives.size(), 5u); // unlit by themselves
    }
    file = right;
    file.json["meshes"][0]["primitives"][0]["attributes"]["_PRT_COLOR_0"] = 999;
    EXPECT_THROW(document_of(file), Error);
    file = right;
    test::set_of(file.json, "vertices").erase("fallback"); // materials alone are not a fallback
    EXPECT_EQ(extract_scene(document_of(file)).primitives.size(), 5u);
    GltfDocument bare = document_of(scene_of_all_kinds());
    const Scene scene = extract_scene(bare);
    EXPECT_THROW(write_fallback(bare, scene, std::vector<glm::vec3>(scene.receivers()), 1), Error);
}

TEST(Fallback, ExposureIgnoresAFewBrightVertices) {
    std::vector<glm::vec3> radiance;
    std::vector<float> areas;
    for (int i = 1; i <= 1000; ++i) {
        radiance.emplace_back(0, static_cast<float>(i > 996 ? 1e6 : i), 0.5f);
        areas.push_back(2);
    }
    EXPECT_NEAR(1 / fallback_exposure(radiance, areas), 995, 1);
    areas.back() = 1000; // large: to be shown
    EXPECT_NEAR(fallback_exposure(radiance, areas), 1e-6f, 1e-9f);
    EXPECT_EQ(fallback_exposure(std::vector<glm::vec3>(3), std::vector<float>(3, 1.0f)), 1);
}

} // namespace
} // namespace prt
