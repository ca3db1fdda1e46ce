// EXT_meshopt_compression: what is written compressed is read back bit by bit.

#include "prt/gltf.h"
#include "prt/support/error.h"
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

/// A curved grid with texture coordinates of two bytes, and an extra image-like view that nothing may touch.
GlbFile grid_file(std::uint32_t size) {
    GlbFile file = test::triangle_file();
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> texcoords, indices;
    for (std::uint32_t y = 0; y <= size; ++y)
        for (std::uint32_t x = 0; x <= size; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(size),
                        v = static_cast<float>(y) / static_cast<float>(size);
            positions.insert(positions.end(), {u, std::sin(3 * u) * v, v});
            normals.insert(normals.end(), {0, 1, 0});
            texcoords.insert(texcoords.end(),
                             {static_cast<std::uint16_t>(65535 * u), static_cast<std::uint16_t>(65535 * v)});
        }
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const auto a = static_cast<std::uint16_t>(y * (size + 1) + x),
                       b = static_cast<std::uint16_t>(a + size + 1);
            const auto a1 = static_cast<std::uint16_t>(a + 1), b1 = static_cast<std::uint16_t>(b + 1);
            indices.insert(indices.end(), {a, b, a1, a1, b, b1});
        }
    const auto position = file.accessor(positions, test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, -1, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    file.json["meshes"][0]["primitives"] = {
        {{"attributes",
          {{"POSITION", position},
           {"NORMAL", file.accessor(normals, test::kFloat, "VEC3", 3)},
           {"TEXCOORD_0", file.accessor(texcoords, test::kUnsignedShort, "VEC2", 2, true)}}},
         {"indices", file.accessor(indices, test::kUnsignedShort, "SCALAR", 1)}}};
    return file;
}

struct Files {
    test::TemporaryFolder folder;
    std::filesystem::path source = folder / "source.glb", plain = folder / "plain.glb",
                          packed = folder / "packed.glb";

    Files() {
        grid_file(40).write(source);
        const GltfDocument document = load_gltf(source);
        save_glb(document, plain);
        save_glb(document, packed, BufferCompression::meshopt);
    }
};

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {(std::istreambuf_iterator<char>(file)), {}};
}

nlohmann::ordered_json json_of(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    return nlohmann::ordered_json::parse(bytes.substr(20, length));
}

TEST(Meshopt, ComesBackBitByBitAndIsSmaller) {
    const Files files;
    EXPECT_LT(2 * std::filesystem::file_size(files.packed), std::filesystem::file_size(files.plain));
    const Scene a = extract_scene(load_gltf(files.source)), b = extract_scene(load_gltf(files.packed));
    EXPECT_EQ(a.vertex_arrays[0].positions, b.vertex_arrays[0].positions);
    EXPECT_EQ(a.vertex_arrays[0].normals, b.vertex_arrays[0].normals);
    EXPECT_EQ(a.vertex_arrays[0].texcoords, b.vertex_arrays[0].texcoords);
    EXPECT_EQ(receivers_id(a), receivers_id(b));
    ASSERT_EQ(a.primitives[0].triangles.size(), b.primitives[0].triangles.size());
    for (std::size_t t = 0; t < a.primitives[0].triangles.size(); ++t) { // the codec may turn a triangle
        const glm::uvec3 x = a.primitives[0].triangles[t], y = b.primitives[0].triangles[t];
        EXPECT_TRUE(x == y || x == glm::uvec3(y.y, y.z, y.x) || x == glm::uvec3(y.z, y.x, y.y)) << t;
    }
}

TEST(Meshopt, SaysThatItIsRequired) {
    const Files files;
    const auto json = json_of(bytes_of(files.packed));
    EXPECT_EQ(json["extensionsRequired"], nlohmann::ordered_json::array({"EXT_meshopt_compression"}));
    EXPECT_TRUE(json["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"]);
}

TEST(Meshopt, ReadAndSavedAgainIsPlain) {
    const Files files;
    save_glb(load_gltf(files.packed), files.folder / "again.glb");
    const auto json = json_of(bytes_of(files.folder / "again.glb"));
    EXPECT_FALSE(json.contains("extensionsRequired"));
    EXPECT_EQ(json["buffers"].size(), 1u);
    const Scene a = extract_scene(load_gltf(files.source)),
                b = extract_scene(load_gltf(files.folder / "again.glb"));
    EXPECT_EQ(receivers_id(a), receivers_id(b));
}

TEST(Meshopt, DamagedDataIsRefused) {
    const Files files;
    const std::string good = bytes_of(files.packed);
    std::uint32_t length = 0;
    std::memcpy(&length, good.data() + 12, 4);
    const auto expect_refused =
        [&](const std::function<void(nlohmann::ordered_json&, std::vector<std::byte>&)>& change) {
            GlbFile file;
            file.json = json_of(good);
            const auto* data = reinterpret_cast<const std::byte*>(good.data());
            file.binary.assign(data + 28 + length, data + good.size());
            change(file.json, file.binary);
            const auto fallback =
                file.json["buffers"].size() > 1 ? file.json["buffers"][1] : nlohmann::ordered_json();
            file.write(files.folder / "bad.glb");
            EXPECT_THROW(load_gltf(files.folder / "bad.glb"), Error);
        };
    const auto view = [](nlohmann::ordered_json& json) -> nlohmann::ordered_json& {
        for (auto& v : json["bufferViews"])
            if (v.contains("extensions"))
                return v["extensions"]["EXT_meshopt_compression"];
        throw std::logic_error("no view is compressed");
    };
    expect_refused([&](auto& json, auto&) { view(json)["count"] = 1u << 30; });
    expect_refused([&](auto& json, auto&) { view(json)["byteStride"] = 13; });
    expect_refused([&](auto& json, auto&) { view(json)["mode"] = "MAGIC"; });
    expect_refused([&](auto& json, auto&) { view(json)["filter"] = "MAGIC"; });
    expect_refused([&](auto& json, auto&) { view(json)["byteLength"] = 1u << 30; });
    expect_refused([&](auto& json, auto&) { view(json).erase("byteLength"); });
    expect_refused([&](auto& json, auto&) { view(json).erase("buffer"); });
    expect_refused([&](auto& json, auto& binary) {
        binary[view(json)["byteOffset"].template get<std::size_t>()] = std::byte{7};
    });
}

} // namespace
} // namespace prt
