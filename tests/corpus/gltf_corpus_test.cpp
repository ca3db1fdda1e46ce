// Tests scenes as exporters write them: one small file for each deviation, named after exporter and
// deviation, with the exact result.
#include "prt/gltf/gltf.h"

#include "bake/gltf/encode_glb.h"
#include "prt/core/error.h"
#include "prt/gltf/animation.h"
#include "runtime/core/support/json_tree.h"
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
    EXPECT_EQ(notices_with(scene, "2 spot lights have an inner cone"), 1);
}

/// Returns a triangle whose positions are compressed under the name `extension`, with gltfpack's file layout.
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

TEST(GltfCorpus, GltfpackMeshoptOfVersionOneIsRejectedWithARemedy) {
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

/// Result of reading a scene with `uri` as base color or normal map, in a folder with "textures/Brick
/// One.png".
struct UriResult {
    std::string trouble; ///< with the image
    std::vector<std::string> notices;
};
UriResult read_with_uri(const std::string& uri, const char* slot = "baseColorTexture") {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "textures");
    folder.file("textures/Brick One.png", "any bytes");
    folder.file("textures/twin.png", "any bytes");
    folder.file("textures/TWIN.png", "any bytes");
    folder.file("pointer.png", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
    GlbFile file = test::triangle_file();
    file.json["images"] = {{{"uri", uri}}};
    file.json["textures"] = {{{"source", 0}}};
    Json material = {{slot, {{"index", 0}}}};
    if (std::string(slot) == "baseColorTexture")
        material = {{"pbrMetallicRoughness", material}};
    file.json["materials"] = Json::array({material});
    file.write(folder / "scene.glb");
    const Scene scene = extract_scene(load_gltf(folder / "scene.glb"));
    return {scene.images.at(0).trouble, scene.notices};
}

TEST(GltfCorpus, EquivalentUris) {
    for (const char* uri : {"textures/Brick%20One.png", "textures/Brick One.png"}) {
        const UriResult result = read_with_uri(uri);
        EXPECT_EQ(result.trouble, "") << uri;
        EXPECT_TRUE(result.notices.empty()) << uri;
    }
    for (const char* uri :
         {"textures\\Brick One.png", "Textures/brick one.PNG", "textures/Brick%20One.png?v=2",
          ".\\textures\\brick%20one.png#t", "textures/Brick%2520One.png"}) {
        const UriResult result = read_with_uri(uri);
        EXPECT_EQ(result.trouble, "") << uri;
        ASSERT_EQ(result.notices.size(), 1u) << uri;
        EXPECT_NE(result.notices[0].find("'textures/Brick One.png' is read"), std::string::npos)
            << result.notices[0];
    }
    const UriResult twin = read_with_uri("textures/Twin.png");
    EXPECT_NE(twin.trouble.find("several names differ only in case"), std::string::npos) << twin.trouble;
    EXPECT_NE(read_with_uri("textures/gone.png").trouble.find("the file does not exist"), std::string::npos);
    EXPECT_NE(read_with_uri("textures/gone%20too.png").trouble.find("the file does not exist"),
              std::string::npos);
    EXPECT_NE(read_with_uri("pointer.png").trouble.find("git lfs pull"), std::string::npos);
}

TEST(GltfCorpus, MissingImagesAreNotices) {
    for (const char* slot : {"normalTexture", "emissiveTexture", "baseColorTexture"}) {
        const UriResult result = read_with_uri("gone.png", slot);
        EXPECT_EQ(std::count_if(result.notices.begin(), result.notices.end(),
                                [](const std::string& notice) {
                                    return notice.find("image 0 'gone.png' cannot be read: the file does "
                                                       "not exist") != std::string::npos;
                                }),
                  1);
    }
}

TEST(GltfCorpus, SketchfabNonFiniteNormalsAndCoordinates) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const bool sparse : {false, true}) {
        GlbFile file = test::triangle_file();
        Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
        const std::vector<float> normals = {0, 0, -1, nan, 0, 1, 0, 0, 0};
        attributes["NORMAL"] = file.accessor(normals, test::kFloat, "VEC3", 3);
        attributes["TEXCOORD_0"] =
            file.accessor(std::vector<float>{0.25f, 0.5f, nan, 1, 1, 1}, test::kFloat, "VEC2", 2);
        if (sparse) {
            const std::vector<std::uint32_t> index = {1};
            const std::vector<float> value = {nan, nan, nan};
            file.json["accessors"][attributes["NORMAL"].get<std::size_t>()]["sparse"] = {
                {"count", 1},
                {"indices",
                 {{"bufferView", file.view(std::as_bytes(std::span(index)))},
                  {"componentType", test::kUnsignedInt}}},
                {"values", {{"bufferView", file.view(std::as_bytes(std::span(value)))}}}};
        }
        const std::string bytes = file.bytes();
        const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
        const Scene scene = extract_scene(document);
        EXPECT_EQ(notices_with(scene, "2 normals are zero or not finite"), 1);
        EXPECT_EQ(notices_with(scene, "1 texture coordinate is not finite"), 1);
        const Scene again = extract_scene(parse_gltf(encode_glb(document), "memory.glb"));
        EXPECT_TRUE(again.notices.empty());
        EXPECT_EQ(receivers_id(again), receivers_id(scene));
        const VertexArray& vertices = again.vertex_arrays.at(0);
        EXPECT_EQ(vertices.normals,
                  (std::vector<glm::vec3>{{0, 0, -1}, {0, 0, 1}, {0, 0, 1}})); // as the triangle is wound
        EXPECT_EQ(vertices.texcoords.at(0), (std::vector<glm::vec2>{{0.25f, 0.5f}, {0, 0}, {1, 1}}));
    }
}

TEST(GltfCorpus, NormalsWithoutDataBecomeTriangleNormals) {
    GlbFile file = test::triangle_file();
    Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    file.json["accessors"].push_back({{"componentType", test::kFloat}, {"type", "VEC3"}, {"count", 3}});
    attributes["NORMAL"] = file.json["accessors"].size() - 1;
    const Scene scene = scene_of(file);
    EXPECT_EQ(notices_with(scene, "3 normals are zero or not finite"), 1);
    EXPECT_EQ(scene.vertex_arrays.at(0).normals, std::vector<glm::vec3>(3, {0, 0, 1}));
}

TEST(GltfCorpus, OctaneInstancesBeyondTheLimit) {
    GlbFile file = test::triangle_file();
    const std::vector<float> points(3 * 100);
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        file.accessor(points, test::kFloat, "VEC3", 3);
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    const std::string bytes = file.bytes();
    const auto read = [&](double limit) {
        return extract_scene(
            parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb", {.scene_limit = limit}));
    };
    EXPECT_THROW(read(1e5), Error);
    EXPECT_EQ(read(1e6).primitives.size(), 100u);
    EXPECT_EQ(read(0).primitives.size(), 100u);
}

TEST(GltfCorpus, LargeExtrasAreKept) {
    GlbFile file = test::triangle_file();
    Json kept = {{"list", Json::array()}};
    for (int i = 0; i < 20'000; ++i)
        kept["list"].push_back(i);
    file.json["extras"] = file.json["extensions"]["OTHER_data"] = kept;
    file.json["extensionsUsed"] = {"OTHER_data", "KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    file.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.json["nodes"][0]["extras"] = kept;
    const std::string bytes = file.bytes();
    const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
    EXPECT_EQ(extract_scene(document).lights.size(), 1u);
    const GlbFile written = test::glb_of(encode_glb(document));
    EXPECT_EQ(written.json["extras"], kept);
    EXPECT_EQ(written.json["extensions"]["OTHER_data"], kept);
    EXPECT_EQ(written.json["nodes"][0]["extras"], kept);
}

TEST(GltfCorpus, AnimationsWithoutDataAreBoundedTogether) {
    GlbFile file = test::triangle_file();
    constexpr int kKeys = 1'000'000;
    for (const char* type : {"SCALAR", "VEC3"})
        file.json["accessors"].push_back({{"componentType", test::kFloat}, {"type", type}, {"count", kKeys}});
    const std::size_t output = file.json["accessors"].size() - 1;
    Json animation = {{"channels", Json::array()},
                      {"samplers", Json::array({{{"input", output - 1}, {"output", output}}})}};
    for (int i = 0; i < 20; ++i)
        animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}});
    file.json["animations"] = Json::array({animation});
    const std::string bytes = file.bytes();
    const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb");
    try {
        const AnimatedScene scene(document);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("memory.glb: the keyframes of its animations"),
                  std::string::npos)
            << error.what();
    }
}

/// Trees of one text by the parser of the library and by that of linear time.
TEST(JsonTree, MatchesTheLibrary) {
    for (const char* text : {"{}", "[]", "3", R"("a\u00e4")", "[1,-2,3.5,true,null,[],{}]",
                             R"({"b":1,"a":{"c":[{"d":2}]},"e":3})", R"({"a":1,"b":2,"a":3})",
                             R"({"z":0,"b":{"a":1,"a":2},"a":1,"b":2,"z":5,"c":6,"b":[7]})"})
        EXPECT_EQ(parse_json_tree<Json>(text).dump(), Json::parse(text).dump()) << text;
    for (const char* text : {"", "{", "[1,]", R"({"a":1}})", "1e999", "nul"})
        EXPECT_THROW(parse_json_tree<Json>(text), Json::exception) << text;
}

/// A tile of 3D Tiles around `glb`: magic, version, length, and four tables of which one has eight bytes.
std::string tile(const std::string& magic, const std::string& glb) {
    std::string bytes = magic;
    const auto add = [&](std::size_t number) {
        for (int i = 0; i < 4; ++i)
            bytes += static_cast<char>(number >> (8 * i) & 0xff);
    };
    const bool instanced = magic == "i3dm";
    for (const std::size_t number :
         {std::size_t{1}, glb.size() + 36, std::size_t{8}, std::size_t{0}, std::size_t{0}, std::size_t{0}})
        add(number);
    if (instanced)
        add(1);
    return bytes + "        " + glb;
}

TEST(GltfCorpus, CesiumTiles) {
    const std::string batched = tile("b3dm", test::triangle_file().bytes()),
                      instanced = tile("i3dm", test::triangle_file().bytes());
    const Scene scene = extract_scene(parse_gltf(std::as_bytes(std::span(batched)), "a.b3dm"));
    EXPECT_EQ(scene.primitives.at(0).triangles.size(), 1u);
    EXPECT_EQ(notices_with(scene, "3D Tiles"), 1);
    try {
        parse_gltf(std::as_bytes(std::span(instanced)), "a.i3dm");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("begins at byte 40"), std::string::npos) << error.what();
    }
}

TEST(GltfCorpus, CesiumOffset) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"CESIUM_RTC"};
    file.json["extensions"]["CESIUM_RTC"]["center"] = {4e6, 5e6, 6e6};
    const Scene scene = scene_of(file), plain = scene_of(test::triangle_file());
    EXPECT_EQ(scene.vertex_arrays.at(0).positions, plain.vertex_arrays.at(0).positions);
    EXPECT_EQ(notices_with(scene, "CESIUM_RTC"), 1);
}

TEST(GltfCorpus, GitLfsPointer) {
    const std::string bytes = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
    try {
        parse_gltf(std::as_bytes(std::span(bytes)), "a.glb");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("git lfs pull"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace prt
