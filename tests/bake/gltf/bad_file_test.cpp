// Tests damaged glTF files: each is rejected with a clear error.

#include "prt/gltf/gltf.h"

#include "prt/core/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace prt {
namespace {

using test::GlbFile;

struct Damage {
    const char* name;
    std::function<void(GlbFile&)> change;
    const char* message; ///< part of the error message
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
        Damage{"no_asset", [](GlbFile& f) { f.json.erase("asset"); }, "not glTF"},
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
        Damage{"attributes_that_are_a_number",
               [](GlbFile& f) {
                   f.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", 3e38}};
               },
               "attributes of a primitive are not an object"},
        Damage{"view_that_is_an_object",
               [](GlbFile& f) {
                   f.json["accessors"][0]["bufferView"] = {{"bufferView", 0}};
               },
               "must be an integer"},
        Damage{"indices_that_are_an_object",
               [](GlbFile& f) {
                   f.json["meshes"][0]["primitives"][0]["indices"] = {{"bufferView", 0}};
               },
               "must be an integer"},
        Damage{"instances_without_attributes",
               [](GlbFile& f) {
                   f.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = nlohmann::json::object();
               },
               "node 0: is damaged glTF: key"},
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
        Damage{"accessor_of_negative_offset", [](GlbFile& f) { f.json["bufferViews"][0]["byteOffset"] = -1; },
               "byteOffset is -1"},
        Damage{"count_of_halves", [](GlbFile& f) { f.json["accessors"][0]["count"] = 2.5; }, "count is 2.5"},
        Damage{"index_that_wraps_around",
               [](GlbFile& f) { primitive(f)["attributes"]["POSITION"] = 1LL << 32; }, "POSITION is 42949"},
        Damage{"overlapping_elements", [](GlbFile& f) { f.json["bufferViews"][0]["byteStride"] = 4; },
               "a stride of only 4 bytes"},
        Damage{"view_that_nobody_reads",
               [](GlbFile& f) {
                   f.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 8}, {"byteLength", 4096}});
               },
               "outside buffer"},
        Damage{"accessor_that_nobody_reads",
               [](GlbFile& f) {
                   nlohmann::ordered_json unread = f.json["accessors"][0];
                   unread["count"] = 4;
                   f.json["accessors"].push_back(unread);
               },
               "accessor 3 reaches outside"},
        Damage{"sparse_values_outside_view",
               [](GlbFile& f) {
                   f.json["accessors"][0]["sparse"] = {
                       {"count", 3},
                       {"indices", {{"bufferView", 2}, {"componentType", test::kUnsignedShort}}},
                       {"values", {{"bufferView", 0}, {"byteOffset", 4}}}};
               },
               "accessor 0 reaches outside"},
        Damage{"short_attribute_that_nobody_reads",
               [](GlbFile& f) {
                   primitive(f)["attributes"]["_FOO"] =
                       f.accessor(std::vector<float>{1, 2}, test::kFloat, "SCALAR", 1);
               },
               "_FOO has 2 elements, but the primitive has 3 vertices"},
        Damage{"short_morph_target",
               [](GlbFile& f) {
                   primitive(f)["targets"] = {
                       {{"_FOO", f.accessor(std::vector<float>{1, 2}, test::kFloat, "SCALAR", 1)}}};
               },
               "_FOO has 2 elements, but the primitive has 3 vertices"},
        Damage{"attribute_without_elements",
               [](GlbFile& f) {
                   f.json["accessors"].push_back(f.json["accessors"][0]);
                   f.json["accessors"].back()["count"] = 0;
                   primitive(f)["attributes"]["_FOO"] = f.json["accessors"].size() - 1;
               },
               "_FOO has 0 elements"},
        Damage{"primitive_that_is_none",
               [](GlbFile& f) {
                   f.json["meshes"][0]["primitives"].insert(f.json["meshes"][0]["primitives"].begin(), 16);
               },
               "primitives"},
        Damage{"primitive_without_attributes", [](GlbFile& f) { primitive(f).erase("attributes"); },
               "no attributes"},
        Damage{"attribute_that_is_an_object",
               [](GlbFile& f) {
                   primitive(f)["attributes"] = {{"a", {{"POSITION", 0}}}};
               },
               "must be an integer"},
        Damage{"second_buffer_in_the_chunk",
               [](GlbFile& f) {
                   f.json["buffers"] = {{{"byteLength", 64}}, {{"byteLength", 64}}};
               },
               "buffer 1 has no URI"},
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
               "index 3 is out of range: there are 3 vertices"},
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
               "vertex 2 is not finite, or more than 1e9 m"},
        Damage{"moved_too_far",
               [](GlbFile& f) {
                   f.json["nodes"][0]["translation"] = {0, 0, -3e18};
               },
               "vertex 0 is not finite, or more than 1e9 m"},
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
        Damage{"name_that_a_terminal_obeys",
               [](GlbFile& f) {
                   f.json["buffers"] = {{{"uri", "\x1b[2J\r\ngone\xc2\x9b.png"}, {"byteLength", 90}}};
               },
               "\\x1b[2J\\x0d gone\\u009b.png"},
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

TEST_P(DamagedGltf, IsReportedInOneLineWithTheFileName) {
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

TEST(DamagedGlb, TruncationIsRejected) {
    const test::TemporaryFolder folder;
    const std::string whole = test::triangle_file().bytes();
    for (std::size_t length = 1; length < whole.size(); length += 7) {
        const auto path = folder.file("cut.glb", whole.substr(0, length));
        EXPECT_THROW(extract_scene(load_gltf(path)), Error) << length;
    }
}

TEST(DamagedGlb, ChangedBytesAreReadOrRejected) {
    const test::TemporaryFolder folder;
    const std::string whole = test::triangle_file().bytes();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ (1 << i % 7));
        const auto path = folder.file("changed.glb", changed);
        try {
            extract_scene(load_gltf(path));
        } catch (const Error&) { // expected; any other exception is a failure
        }
    }
}

std::string refusal_of(const std::string& file, const char* name = "bad.glb") {
    try {
        extract_scene(parse_gltf(std::as_bytes(std::span(file)), name));
    } catch (const Error& error) {
        return error.what();
    }
    return "was read";
}

TEST(HostileGltf, NestsNoDeeperThanItsReadersHaveStackFor) {
    const std::string asset = "{\"asset\":{\"version\":\"2.0\"},";
    const auto nested = [](std::size_t levels) {
        return std::string(levels, '[') + "\"]\"" + std::string(levels, ']');
    };
    for (const char* member : {"\"extras\"", "\"unknown\"", "\"extensions\""})
        for (const std::size_t levels : {std::size_t{1000}, std::size_t{100'000}, std::size_t{1'000'000}})
            EXPECT_NE(refusal_of(asset + member + ":" + nested(levels) + "}", "bad.gltf")
                          .find("more than 256 levels deep"),
                      std::string::npos);
    EXPECT_NE(refusal_of(asset + "\"extras\":" + nested(200) + "}", "bad.gltf").find("no triangles"),
              std::string::npos);
    GlbFile binary = test::triangle_file();
    for (int level = 0; level < 1000; ++level)
        binary.json["extras"] = nlohmann::ordered_json::array({std::move(binary.json["extras"])});
    EXPECT_NE(refusal_of(binary.bytes()).find("more than 256 levels deep"), std::string::npos);
}

TEST(HostileGltf, ZerosAndInstancesAreBounded) {
    GlbFile zeros = test::triangle_file();
    for (std::size_t a : {0, 1}) {
        zeros.json["accessors"][a]["count"] = 67'108'864;
        zeros.json["accessors"][a].erase("bufferView");
    }
    EXPECT_NE(refusal_of(zeros.bytes()).find("accessor 0, which has no buffer view, would need 805 MB"),
              std::string::npos);
    // Each within the bound, all together not.
    GlbFile often = test::triangle_file();
    for (std::size_t a : {0, 1}) {
        often.json["accessors"][a]["count"] = 1'000'000;
        often.json["accessors"][a].erase("bufferView");
    }
    for (int i = 0; i < 8; ++i)
        often.json["nodes"].push_back({{"mesh", 0}});
    often.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7};
    EXPECT_NE(refusal_of(often.bytes()).find("(with instances and morph targets) would need"),
              std::string::npos);
    often.json["scenes"][0]["nodes"] = {0};
    EXPECT_EQ(refusal_of(often.bytes()), "was read");
}

/// Returns a file whose node 0 has `count` instances of the mesh, at the origin.
GlbFile instanced_file(std::size_t count) {
    GlbFile file = test::triangle_file();
    const std::size_t positions = file.json["accessors"].size();
    file.json["accessors"].push_back({{"componentType", test::kFloat}, {"count", count}, {"type", "VEC3"}});
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", positions}};
    return file;
}

TEST(HostileGltf, NodesOfInstancesAreBounded) {
    EXPECT_NE(refusal_of(instanced_file(300'000).bytes()).find("its instances would need 420 MB"),
              std::string::npos);
    GlbFile weighted = instanced_file(10'000);
    EXPECT_EQ(refusal_of(weighted.bytes()), "was read");
    weighted.json["nodes"][0]["weights"] = std::vector<double>(1000, 0.5);
    EXPECT_NE(refusal_of(weighted.bytes()).find("its instances would need 414 MB"), std::string::npos);
}

TEST(HostileGltf, WideAttributesAreBounded) {
    GlbFile file = test::triangle_file();
    for (const char* type : {"VEC3", "MAT4"})
        file.json["accessors"].push_back(
            {{"componentType", test::kFloat}, {"count", 1'000'000}, {"type", type}});
    const std::size_t matrices = file.json["accessors"].size() - 1;
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes = {{"POSITION", matrices - 1}};
    EXPECT_EQ(refusal_of(file.bytes()), "was read");
    for (const char* name : {"_A", "_B", "_C"})
        attributes[name] = matrices;
    const std::string refused = refusal_of(file.bytes());
    EXPECT_NE(refused.find("would need 280 MB"), std::string::npos) << refused;
}

TEST(HostileGltf, SharedMeshesAreBoundedWhenCopiedForNodes) {
    GlbFile file = test::triangle_file();
    file.json["meshes"][0]["extras"] = std::vector<int>(100'000, 1);
    for (int i = 1; i < 200; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["scenes"][0]["nodes"].push_back(i);
    }
    const std::string bytes = file.bytes();
    GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "bad.glb");
    const Scene scene = extract_scene(document);
    const BakedTransfer baked{zero_transfer(1, 1, scene.receivers()), {}};
    try {
        write_transfer(document, scene, baked);
        ADD_FAILURE() << "was written";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("copied for each node, would need"), std::string::npos);
    }
}

TEST(HostileGltf, LongNamesOfAttributesAreHeldOnce) {
    GlbFile file = test::triangle_file();
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes[std::string(1'000'000, '_')] = attributes["POSITION"];
    for (int i = 1; i < 1000; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["scenes"][0]["nodes"].push_back(i);
    }
    EXPECT_EQ(refusal_of(file.bytes()), "was read");
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 800'000) << "kilobytes";
}

TEST(HostileGltf, ListsAreBoundedByDecodedSize) {
    GlbFile file = test::triangle_file();
    file.json["materials"] = std::vector<nlohmann::ordered_json>(400'000, nlohmann::ordered_json::object());
    EXPECT_NE(refusal_of(file.bytes()).find("its JSON would need"), std::string::npos);
}

TEST(HostileGltf, ImagesWithSharedBytesAreBounded) {
    GlbFile file = test::triangle_file();
    const std::size_t view = file.view(std::vector<std::byte>(1'000'000));
    for (int i = 0; i < 300; ++i)
        file.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    EXPECT_NE(refusal_of(file.bytes()).find("the encoded images would need"), std::string::npos);
}

TEST(HostileGltf, CompressedViewsAreBounded) {
    GlbFile file = test::triangle_file();
    const std::size_t view = file.view(std::vector<std::byte>(20'000));
    file.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},          {"byteOffset", file.json["bufferViews"][view]["byteOffset"]},
        {"byteLength", 20'000}, {"byteStride", 256},
        {"count", 20'000'000},  {"mode", "ATTRIBUTES"}};
    EXPECT_NE(refusal_of(file.bytes()).find("would need 10240 MB"), std::string::npos);
}

TEST(DamagedGltfText, IsRejected) {
    const test::TemporaryFolder folder;
    for (const char* text : {"{", "[]", "3", "{}", "hello", "{\"asset\":{}}", "\xff\xfe"})
        EXPECT_THROW(load_gltf(folder.file("text.gltf", text)), Error) << text;
}

} // namespace
} // namespace prt
