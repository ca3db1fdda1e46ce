// Scenes as exporters write them: one small file for each deviation, named after exporter and deviation, and
// the exact answer beside it.
#include "prt/gltf.h"

#include "prt/support/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

Scene scene_of(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb"));
}

std::string refusal_of(const GlbFile& file) {
    try {
        scene_of(file);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// The number of notices that contain `words`.
std::ptrdiff_t notices_with(const Scene& scene, const std::string& words) {
    return std::count_if(scene.notices.begin(), scene.notices.end(),
                         [&](const std::string& notice) { return notice.find(words) != std::string::npos; });
}

/// A triangle and a node for each of `lights`.
GlbFile with_lights(const std::vector<Json>& lights) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = lights;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    }
    return file;
}

TEST(GltfCorpus, BabylonFor3dsMaxRangeOfTheLargestFloat) {
    const Json endless = {{"type", "point"}, {"range", 3.40282347e+38}};
    const Scene scene = scene_of(with_lights({endless, endless, {{"type", "point"}, {"range", 0}}}));
    ASSERT_EQ(scene.lights.size(), 3u);
    for (const PunctualLight& light : scene.lights)
        EXPECT_EQ(light.range, std::numeric_limits<float>::infinity());
    EXPECT_EQ(notices_with(scene, "3 lights have a range"), 1);
}

TEST(GltfCorpus, BabylonFor3dsMaxNullSpot) {
    const Scene scene = scene_of(with_lights({{{"type", "directional"}, {"spot", nullptr}},
                                              {{"type", "spot"}, {"spot", nullptr}, {"range", nullptr}}}));
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[1].outer_cone, static_cast<float>(std::numbers::pi / 4));
    EXPECT_EQ(notices_with(scene, "3 members of its JSON are null"), 1);
}

TEST(GltfCorpus, NullMembersOfMeshesAndNodes) {
    GlbFile file = test::triangle_file();
    file.json["nodes"][0]["camera"] = nullptr;
    file.json["nodes"][0]["extras"] = {{"kept", nullptr}};
    file.json["meshes"][0]["primitives"][0]["material"] = nullptr;
    file.json["materials"] = nullptr;
    const Scene scene = scene_of(file);
    EXPECT_EQ(scene.primitives.at(0).triangles.size(), 1u);
    EXPECT_EQ(notices_with(scene, "3 members of its JSON are null"), 1);
}

TEST(GltfCorpus, BlenderSpotWithoutBlend) {
    const float angle = 0.39269909f;
    const Scene scene = scene_of(
        with_lights({{{"type", "spot"}, {"spot", {{"innerConeAngle", angle}, {"outerConeAngle", angle}}}},
                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.9}, {"outerConeAngle", angle}}}}}));
    ASSERT_EQ(scene.lights.size(), 2u);
    for (const PunctualLight& light : scene.lights) {
        EXPECT_EQ(light.inner_cone, angle);
        EXPECT_EQ(light.outer_cone, angle);
    }
    EXPECT_EQ(notices_with(scene, "2 spots have an inner cone"), 1);
}

/// A triangle whose positions are compressed under the name `extension`, as gltfpack lays files out.
GlbFile with_meshopt(const char* extension) {
    GlbFile file = test::triangle_file();
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    const auto accessor = primitive["attributes"]["POSITION"].get<std::size_t>();
    const auto index = file.json["accessors"][accessor]["bufferView"].get<std::size_t>();
    constexpr std::size_t kCount = 3, kStride = 12;
    const Json plain = file.json["bufferViews"][index];
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(kCount, kStride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(),
                                             &file.binary[plain.value("byteOffset", std::size_t{0})], kCount,
                                             kStride));
    const std::size_t source = file.view(std::as_bytes(std::span(packed)));
    const Json at = file.json["bufferViews"][source];
    file.json["bufferViews"].erase(source);
    file.json["bufferViews"][index] = {{"buffer", 1},
                                       {"byteLength", kCount * kStride},
                                       {"byteStride", kStride},
                                       {"extensions",
                                        {{extension,
                                          {{"buffer", 0},
                                           {"byteOffset", at["byteOffset"]},
                                           {"byteLength", at["byteLength"]},
                                           {"byteStride", kStride},
                                           {"count", kCount},
                                           {"mode", "ATTRIBUTES"}}}}}};
    file.json["buffers"] = {
        {{"byteLength", file.binary.size()}},
        {{"byteLength", kCount * kStride}, {"extensions", {{extension, {{"fallback", true}}}}}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {extension};
    return file;
}

TEST(GltfCorpus, GltfpackKhronosMeshopt) {
    const Scene plain = scene_of(test::triangle_file());
    const GlbFile file = with_meshopt("KHR_meshopt_compression");
    const Scene scene = scene_of(file);
    ASSERT_EQ(scene.vertex_arrays.size(), 1u);
    EXPECT_EQ(scene.vertex_arrays[0].positions, plain.vertex_arrays[0].positions);
    EXPECT_EQ(scene_of(with_meshopt("EXT_meshopt_compression")).vertex_arrays[0].positions,
              plain.vertex_arrays[0].positions);
}

TEST(GltfCorpus, GltfpackMeshoptOfVersionOneIsRefusedWithARemedy) {
    GlbFile file = with_meshopt("KHR_meshopt_compression");
    for (const Json& view : file.json["bufferViews"])
        if (view.contains("extensions"))
            file.binary.at(view["extensions"]["KHR_meshopt_compression"]["byteOffset"].get<std::size_t>()) =
                std::byte{0xa1};
    const std::string refusal = refusal_of(file);
    EXPECT_NE(refusal.find("version 1 of the attribute codec"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("EXT_meshopt_compression"), std::string::npos) << refusal;
}

TEST(GltfCorpus, SparseAccessorWithoutBufferView) {
    GlbFile file = test::triangle_file();
    const std::vector<std::uint16_t> indices = {1, 2};
    const std::vector<float> values = {1, 0, 0, 0, 1, 0}; // the first vertex stays at zero
    const std::size_t i = file.view(std::as_bytes(std::span(indices))),
                      v = file.view(std::as_bytes(std::span(values)));
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    Json& accessor = file.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    accessor.erase("bufferView");
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", i}, {"componentType", test::kUnsignedShort}}},
                          {"values", {{"bufferView", v}}}};
    EXPECT_EQ(scene_of(file).vertex_arrays.at(0).positions,
              scene_of(test::triangle_file()).vertex_arrays.at(0).positions);
}

TEST(GltfCorpus, GltfpackQuantizedPositionsOfSixteenBits) {
    GlbFile file = test::triangle_file();
    // Four components each, for alignment: the stride skips the last.
    const std::vector<std::uint16_t> grid = {0, 0, 0, 0, 16383, 0, 0, 0, 0, 16383, 0, 0};
    const std::size_t position =
        file.accessor(std::as_bytes(std::span(grid)), 3, test::kUnsignedShort, "VEC3", false, 8);
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = position;
    file.json["nodes"][0]["scale"] = {1.0 / 16383, 1.0 / 16383, 1.0 / 16383};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Scene scene = scene_of(file);
    const auto& positions = scene.vertex_arrays.at(0).positions;
    ASSERT_EQ(positions.size(), 3u);
    EXPECT_NEAR(scene.world(positions[1]).x, 1, 1e-6);
    EXPECT_NEAR(scene.world(positions[2]).y, 1, 1e-6);
}

} // namespace
} // namespace prt
