// Tests entropy-coded words of vertices in files: they are read back bit by bit.

#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>

namespace prt {
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

constexpr const char* kExtension = "PRTKIT_transfer";

/// Returns three primitives of `size` vertices along a side: two halves of one grid with common vertices, and
/// a second grid, drawn as a strip.
GlbFile grids(std::uint32_t size) {
    GlbFile file = test::triangle_file();
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> halves[2], strip;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            positions.insert(positions.end(), {static_cast<float>(x), 0.f, static_cast<float>(y)});
            normals.insert(normals.end(), {0, 1, 0});
            const auto a = static_cast<std::uint16_t>(y * size + x), b = static_cast<std::uint16_t>(a + size);
            if (x + 1 < size && y + 1 < size)
                for (const int corner : {+a, +b, a + 1, a + 1, +b, b + 1})
                    halves[y % 2].push_back(static_cast<std::uint16_t>(corner));
            if (y + 1 < size)
                strip.insert(strip.end(), {a, b});
        }
    Json primitives = Json::array();
    Json attributes;
    for (int i = 0; i < 3; ++i) {
        if (i != 1)
            attributes = {{"POSITION", file.accessor(positions, test::kFloat, "VEC3", 3)},
                          {"NORMAL", file.accessor(normals, test::kFloat, "VEC3", 3)}};
        file.json["accessors"][attributes["POSITION"].get<std::size_t>()]["min"] = {0, 0, 0};
        file.json["accessors"][attributes["POSITION"].get<std::size_t>()]["max"] = {size, 0, size};
        primitives.push_back(
            {{"attributes", attributes},
             {"indices", file.accessor(i < 2 ? halves[i] : strip, test::kUnsignedShort, "SCALAR", 1)},
             {"mode", i < 2 ? 4 : 5}});
    }
    file.json["meshes"][0]["primitives"] = primitives;
    return file;
}

/// Returns three clusters with at most one weight; weights are waves.
CompressedTransfer transfer_of(const Scene& scene, std::uint32_t size) {
    CompressedTransfer compressed;
    compressed.record.receivers = receivers_id(scene);
    ClusteredTransfer& transfer = compressed.transfer;
    ClusteredBases& bases = transfer.bases;
    bases.layout = layout_of_one(1, 1);
    bases.components = {1, 1, 0};
    bases.rows = {0, 1, 0, 1, 0};
    bases.bits = {9, 14};
    ClusteredReceivers& receivers = transfer.receivers;
    receivers.format = WeightFormat::packed;
    receivers.cluster_bits = 2;
    receivers.words = 1;
    for (std::uint32_t v = 0; v < scene.receivers(); ++v) {
        const float x = static_cast<float>(v % size),
                    y = std::floor(static_cast<float>(v) / static_cast<float>(size));
        const std::uint32_t cluster = v % size / 10 % 3;
        const auto wave = static_cast<std::uint32_t>((0.5f + 0.4f * std::sin(0.2f * x + 0.1f * y)) * 512);
        const std::uint32_t bits = cluster == 0 ? 9 : cluster == 1 ? 14 : 0;
        const std::uint32_t weight = wave & ((1u << bits) - 1);
        const std::uint32_t word = cluster | weight << 2;
        const auto* bytes = reinterpret_cast<const std::byte*>(&word);
        receivers.weights.insert(receivers.weights.end(), bytes, bytes + sizeof word);
    }
    return compressed;
}

Json json_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    return Json::parse(bytes.substr(20, length));
}

constexpr std::uint32_t kSize = 40;

struct Files {
    test::TemporaryFolder folder;
    std::filesystem::path plain = folder / "plain.glb", coded = folder / "coded.glb";

    explicit Files(std::uint32_t size = kSize) {
        grids(size).write(folder / "scene.glb");
        GltfDocument document = load_gltf(folder / "scene.glb");
        const Scene scene = extract_scene(document);
        write_clustered(document, scene, transfer_of(scene, size));
        save_glb(document, plain);
        save_glb(document, coded, BufferCompression::meshopt);
    }
};

ClusteredReceivers read(const std::filesystem::path& path) {
    const GltfDocument document = load_gltf(path);
    return read_clustered(document, extract_scene(document))->transfer.receivers;
}

TEST(CodedVertices, RoundTripExactly) {
    const Files files;
    const Json json = json_of(files.coded);
    EXPECT_EQ(test::set_of(json, "vertices")["packing"]["words"]["vertices"], 2 * kSize * kSize);
    for (const std::size_t p : {0u, 1u, 2u}) {
        const Json& primitive = json["meshes"][0]["primitives"][p];
        EXPECT_FALSE(primitive["attributes"].contains("_PRT_WEIGHTS_0"));
        EXPECT_EQ(primitive["extensions"][kExtension]["firstVertex"], p < 2 ? 0 : kSize * kSize);
    }
    const ClusteredReceivers plain = read(files.plain), coded = read(files.coded);
    EXPECT_EQ(coded.weights, plain.weights);
    EXPECT_EQ(coded.clusters, plain.clusters);
    EXPECT_EQ(plain.size(), 2 * kSize * kSize);
}

TEST(CodedVertices, AreSavedAsPlainAttributes) {
    const Files files;
    save_glb(load_gltf(files.coded), files.folder / "again.glb");
    const Json json = json_of(files.folder / "again.glb");
    EXPECT_FALSE(test::set_of(json, "vertices")["packing"].contains("words"));
    for (const Json& primitive : json["meshes"][0]["primitives"]) {
        EXPECT_TRUE(primitive["attributes"].contains("_PRT_WEIGHTS_0"));
        EXPECT_FALSE(primitive.contains("extensions"));
    }
    EXPECT_EQ(read(files.folder / "again.glb").weights, read(files.plain).weights);
    // No code remains in the file: only padding, and the description of interleaved views.
    EXPECT_LT(std::filesystem::file_size(files.folder / "again.glb"),
              std::filesystem::file_size(files.plain) + 200);
}

TEST(CodedVertices, AreUsedOnlyIfSmallerThanAttributes) {
    const Files files(3); // smaller than the frequencies
    EXPECT_FALSE(test::set_of(json_of(files.coded), "vertices")["packing"].contains("words"));
    EXPECT_EQ(read(files.coded).weights, read(files.plain).weights);
}

TEST(CodedVertices, DamageIsRejected) {
    const Files files;
    std::ifstream stream(files.coded, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(stream), {}};
    std::uint32_t length = 0;
    std::memcpy(&length, good.data() + 12, 4);
    const auto expect_refused = [&](const std::string& message, const std::function<void(Json&)>& change) {
        GlbFile file;
        file.json = json_of(files.coded);
        const auto* data = reinterpret_cast<const std::byte*>(good.data());
        file.binary.assign(data + 28 + length, data + good.size());
        change(file.json);
        file.write(files.folder / "bad.glb");
        try {
            load_gltf(files.folder / "bad.glb");
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    };
    const auto words = [](Json& json) -> Json& { return test::set_of(json, "vertices")["packing"]["words"]; };
    const auto first = [](Json& json) -> Json& {
        return json["meshes"][0]["primitives"][2]["extensions"][kExtension]["firstVertex"];
    };
    expect_refused("vertices is 0", [&](Json& json) { words(json)["vertices"] = 0; });
    expect_refused("would need", [&](Json& json) { words(json)["vertices"] = 2'000'000'000; });
    expect_refused("the coded words end too early",
                   [&](Json& json) { words(json)["vertices"] = 2 * kSize * kSize + 1; });
    expect_refused("beyond the", [&](Json& json) { words(json)["vertices"] = kSize * kSize; });
    expect_refused("beyond the", [&](Json& json) { first(json) = kSize * kSize + 1; });
    expect_refused("firstVertex is -1", [&](Json& json) { first(json) = -1; });
    expect_refused("end too early", [&](Json& json) { words(json)["frequencies"]["byteLength"] = 1 << 20; });
    expect_refused("is 16", [&](Json& json) { words(json)["frequencies"]["drops"][0] = 16; });
    expect_refused("15 columns", [&](Json& json) { words(json)["frequencies"]["drops"].erase(0); });
    expect_refused("damaged glTF", [&](Json& json) { words(json).erase("frequencies"); });
}

/// Words are predicted from neighbours: vertices in another order have other words, which ends in a damaged
/// code.
TEST(CodedVertices, ReorderedMeshesAreRejectedWithTheRemedy) {
    const Files files;
    GlbFile file = test::read_glb(files.coded);
    std::vector<std::uint16_t> indices;
    const std::uint32_t count = kSize * kSize;
    for (std::uint32_t v = 0; v + kSize + 1 < count; ++v)
        for (const std::uint32_t corner : {v, v + kSize, v + 1})
            indices.push_back(static_cast<std::uint16_t>(corner * 7919u % count));
    file.json["meshes"][0]["primitives"][0]["indices"] =
        file.accessor(indices, test::kUnsignedShort, "SCALAR", 1);
    file.json["buffers"][0]["byteLength"] = file.binary.size();
    file.write(files.folder / "reordered.glb");
    try {
        load_gltf(files.folder / "reordered.glb");
        ADD_FAILURE() << "was read";
    } catch (const Error& error) {
        EXPECT_NE(
            std::string(error.what()).find("another program has changed the file; run that program before"),
            std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace prt
