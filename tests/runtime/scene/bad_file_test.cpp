#include "prt/gltf.h"

#include "prt/support/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace prt {
namespace {

using test::GlbFile;

struct Damage {
    const char* name;
    std::function<void(GlbFile&)> change;
    const char* message; ///< part of what the user is told
};
void PrintTo(const Damage& damage, std::ostream* out) {
    *out << damage.name;
}

nlohmann::ordered_json& primitive(GlbFile& file) {
    return file.json["meshes"][0]["primitives"][0];
}

class DamagedGltf : public testing::TestWithParam<Damage> {};

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedGltf,
    testing::Values(
        Damage{"no_asset", [](GlbFile& f) { f.json.erase("asset"); }, "no glTF"},
        Damage{"version_1", [](GlbFile& f) { f.json["asset"]["version"] = "1.0"; }, "version '1.0'"},
        Damage{"asset_of_wrong_type", [](GlbFile& f) { f.json["asset"]["version"] = 2; }, "glTF"},
        Damage{"unknown_extension", [](GlbFile& f) { f.json["extensionsRequired"] = {"EXT_unheard_of"}; },
               "EXT_unheard_of"},
        Damage{"missing_buffer_file",
               [](GlbFile& f) {
                   f.json["buffers"] = {{{"uri", "gone.bin"}, {"byteLength", 99}}};
               },
               "gone.bin"},
        Damage{"short_buffer",
               [](GlbFile& f) {
                   f.json["buffers"] = {{{"byteLength", 9999}}};
               },
               ""},
        Damage{"view_outside_buffer", [](GlbFile& f) { f.json["bufferViews"][0]["byteLength"] = 4000; },
               "outside buffer"},
        Damage{"view_of_no_buffer", [](GlbFile& f) { f.json["bufferViews"][0]["buffer"] = 7; }, ""},
        Damage{"accessor_outside_view", [](GlbFile& f) { f.json["accessors"][0]["count"] = 4; }, "outside"},
        Damage{"accessor_offset_outside", [](GlbFile& f) { f.json["accessors"][0]["byteOffset"] = 4000; },
               "outside"},
        Damage{"accessor_huge", [](GlbFile& f) { f.json["accessors"][0]["count"] = 1LL << 60; }, ""},
        Damage{"accessor_huge_without_data",
               [](GlbFile& f) {
                   f.json["accessors"][0]["count"] = 1LL << 40;
                   f.json["accessors"][0].erase("bufferView");
               },
               ""},
        Damage{"accessor_of_no_view", [](GlbFile& f) { f.json["accessors"][0]["bufferView"] = 99; }, ""},
        Damage{"no_such_accessor", [](GlbFile& f) { primitive(f)["attributes"]["POSITION"] = 55; }, "55"},
        Damage{"position_of_two_components", [](GlbFile& f) { f.json["accessors"][0]["type"] = "VEC2"; }, ""},
        Damage{"normals_of_other_number",
               [](GlbFile& f) {
                   primitive(f)["attributes"]["NORMAL"] =
                       f.accessor(std::vector<float>(6, 1.0f), test::kFloat, "VEC3", 3);
               },
               "NORMAL"},
        Damage{"index_beyond_vertices",
               [](GlbFile& f) {
                   primitive(f)["indices"] =
                       f.accessor(std::vector<std::uint16_t>{0, 1, 3}, test::kUnsignedShort, "SCALAR", 1);
               },
               "index 3 is beyond its 3 vertices"},
        Damage{
            "float_indices",
            [](GlbFile& f) {
                primitive(f)["indices"] = f.accessor(std::vector<float>{0, 1, 2}, test::kFloat, "SCALAR", 1);
            },
            "unsigned"},
        Damage{"nan_position",
               [](GlbFile& f) {
                   primitive(f)["attributes"]["POSITION"] = f.accessor(
                       std::vector<float>{0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0}, test::kFloat, "VEC3", 3);
               },
               "vertex 1 is not finite"},
        Damage{"infinite_position",
               [](GlbFile& f) {
                   primitive(f)["attributes"]["POSITION"] = f.accessor(
                       std::vector<float>{0, 0, 0, 1, 0, 0, 0, INFINITY, 0}, test::kFloat, "VEC3", 3);
               },
               "vertex 2 is not finite"},
        Damage{"overflowing_transform",
               [](GlbFile& f) {
                   f.json["nodes"][0]["scale"] = {1e39, 1, 1};
               },
               "not finite"},
        Damage{"scaled_too_far",
               [](GlbFile& f) {
                   f.json["nodes"][0]["scale"] = {1, 1.01 * kFarthestVertex, 1};
               },
               "vertex 2 is not finite, or farther than 1e9 m"},
        Damage{"moved_too_far",
               [](GlbFile& f) {
                   f.json["nodes"][0]["translation"] = {0, 0, -3e18};
               },
               "vertex 0 is not finite, or farther than 1e9 m"},
        Damage{"no_meshes",
               [](GlbFile& f) {
                   f.json.erase("meshes");
                   f.json["nodes"][0].erase("mesh");
               },
               "no triangles"},
        Damage{"only_points", [](GlbFile& f) { primitive(f)["mode"] = 0; }, "no triangles"},
        Damage{"no_such_mesh", [](GlbFile& f) { f.json["nodes"][0]["mesh"] = 3; }, "mesh 3"},
        Damage{"no_such_node", [](GlbFile& f) { f.json["scenes"][0]["nodes"] = {4}; }, "node 4"},
        Damage{"no_such_scene", [](GlbFile& f) { f.json["scene"] = 2; }, "scene 2"},
        Damage{"own_ancestor",
               [](GlbFile& f) {
                   f.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
               },
               "node 0"},
        Damage{"no_such_material", [](GlbFile& f) { primitive(f)["material"] = 9; }, "material 9"},
        Damage{"missing_image",
               [](GlbFile& f) {
                   f.json["images"] = {{{"uri", "gone.png"}}};
               },
               "gone.png"},
        Damage{
            "image_outside_buffer",
            [](GlbFile& f) {
                f.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 100000}, {"byteLength", 10}});
                f.json["images"] = {
                    {{"bufferView", f.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
            },
            ""},
        Damage{"attributes_of_wrong_type", [](GlbFile& f) { primitive(f)["attributes"] = 3; }, ""},
        Damage{"nodes_of_wrong_type", [](GlbFile& f) { f.json["nodes"] = "x"; }, ""}),
    [](const auto& kind) { return kind.param.name; });

TEST_P(DamagedGltf, IsOneClearLineThatNamesTheFile) {
    const test::TemporaryFolder folder;
    GlbFile file = test::triangle_file();
    GetParam().change(file);
    file.write(folder / "bad.glb");
    try {
        extract_scene(load_gltf(folder / "bad.glb"));
        FAIL() << "was read";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with((folder / "bad.glb").string() + ": ")) << message;
        EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(DamagedGlb, CutAnywhereIsRefused) {
    const test::TemporaryFolder folder;
    const std::string whole = test::triangle_file().bytes();
    for (std::size_t length = 1; length < whole.size(); length += 7) {
        const auto path = folder.file("cut.glb", whole.substr(0, length));
        EXPECT_THROW(extract_scene(load_gltf(path)), Error) << length;
    }
}

TEST(DamagedGlb, EveryByteChangedIsReadOrRefused) {
    const test::TemporaryFolder folder;
    const std::string whole = test::triangle_file().bytes();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ (1 << i % 7));
        const auto path = folder.file("changed.glb", changed);
        try {
            extract_scene(load_gltf(path));
        } catch (const Error&) { // fine: the point is that nothing else happens
        }
    }
}

TEST(DamagedGltfText, IsRefused) {
    const test::TemporaryFolder folder;
    for (const char* text : {"{", "[]", "3", "{}", "hello", "{\"asset\":{}}", "\xff\xfe"})
        EXPECT_THROW(load_gltf(folder.file("text.gltf", text)), Error) << text;
}

} // namespace
} // namespace prt
