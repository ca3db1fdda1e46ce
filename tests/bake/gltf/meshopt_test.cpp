// Tests EXT_meshopt_compression: compressed data are read back bit by bit.

#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>

namespace prt {
namespace {

using test::GlbFile;

/// Returns a curved grid with texture coordinates of two bytes, and an additional view that must stay
/// unchanged.
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

TEST(Meshopt, RoundTripsExactlyAndIsSmaller) {
    const Files files;
    EXPECT_LT(2 * std::filesystem::file_size(files.packed), std::filesystem::file_size(files.plain));
    const Scene a = extract_scene(load_gltf(files.source)), b = extract_scene(load_gltf(files.packed));
    EXPECT_EQ(a.vertex_arrays[0].positions, b.vertex_arrays[0].positions);
    EXPECT_EQ(a.vertex_arrays[0].normals, b.vertex_arrays[0].normals);
    EXPECT_EQ(a.vertex_arrays[0].texcoords, b.vertex_arrays[0].texcoords);
    EXPECT_EQ(receivers_id(a), receivers_id(b));
    ASSERT_EQ(a.primitives[0].triangles.size(), b.primitives[0].triangles.size());
    // the codec may rotate the corners of a triangle
    for (std::size_t t = 0; t < a.primitives[0].triangles.size(); ++t) {
        const glm::uvec3 x = a.primitives[0].triangles[t], y = b.primitives[0].triangles[t];
        EXPECT_TRUE(x == y || x == glm::uvec3(y.y, y.z, y.x) || x == glm::uvec3(y.z, y.x, y.y)) << t;
    }
}

TEST(Meshopt, IsListedAsRequired) {
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

TEST(Meshopt, DamagedDataIsRejected) {
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

/// Adds a compressed view of `values`, which have the format of a filter's output; elements have `stride`
/// bytes.
template <class T>
std::size_t filtered_view(GlbFile& file, const std::vector<T>& values, std::size_t stride,
                          const char* filter) {
    const std::size_t count = values.size() * sizeof(T) / stride;
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(count, stride));
    meshopt_encodeVertexVersion(0); // version required by the extension
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), values.data(), count, stride));
    const std::size_t index = file.view(std::as_bytes(std::span(packed)), stride);
    auto& view = file.json["bufferViews"][index];
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", view["byteOffset"]},
                                                     {"byteLength", packed.size()},
                                                     {"byteStride", stride},
                                                     {"count", count},
                                                     {"mode", "ATTRIBUTES"},
                                                     {"filter", filter}};
    view["byteLength"] = count * stride;
    return index;
}

Scene scene_in(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "filtered.glb"));
}

/// The triangle with these three normals, integers of the type T.
template <class T>
GlbFile with_octahedral_normals(const std::vector<glm::vec3>& normals, int component_type) {
    constexpr T kOne = std::numeric_limits<T>::max();
    const auto rounded = [](float v) { return static_cast<T>(std::lround(v * static_cast<float>(kOne))); };
    std::vector<T> values;
    for (const glm::vec3& n : normals) {
        glm::vec2 p = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        if (n.z < 0)
            p = {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
        values.insert(values.end(), {rounded(p.x), rounded(p.y), kOne, T{0}});
    }
    GlbFile file = test::triangle_file();
    file.json["accessors"][1] = {{"bufferView", filtered_view(file, values, 4 * sizeof(T), "OCTAHEDRAL")},
                                 {"componentType", component_type},
                                 {"normalized", true},
                                 {"count", 3},
                                 {"type", "VEC3"}};
    return file;
}

// The filters as the extension defines them.
TEST(Meshopt, OctahedralNormalsOfEightAndSixteenBitsAreUnfolded) {
    const std::vector<glm::vec3> normals = {glm::normalize(glm::vec3(1, -2, 3)),
                                            glm::normalize(glm::vec3(-3, -1, -2)),
                                            glm::normalize(glm::vec3(2, 1, -0.5f))};
    const auto expect_normals = [&](const GlbFile& file, float step) {
        const Scene scene = scene_in(file);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_LT(glm::distance(scene.vertex_arrays[0].normals[i], normals[i]), 2 * step) << i;
    };
    expect_normals(with_octahedral_normals<std::int8_t>(normals, test::kByte), 1.0f / 127);
    expect_normals(with_octahedral_normals<std::int16_t>(normals, test::kShort), 1.0f / 32767);
}

TEST(Meshopt, ExponentialPositionsAreMantissasTimesPowersOfTwo) {
    const auto number = [](std::uint32_t mantissa, int exponent) {
        return static_cast<std::uint32_t>(exponent) << 24 | (mantissa & 0xffffffu);
    };
    GlbFile file = test::triangle_file();
    file.json["accessors"][0]["bufferView"] =
        filtered_view(file,
                      std::vector{number(5, -2), number(-3u, 1), number(0, 0), number(1, 3), number(1, 0),
                                  number(7, -3), number(-1u, 0), number(3, 0), number(-1u, -1)},
                      12, "EXPONENTIAL");
    const glm::vec3 expected[] = {{1.25f, -6, 0}, {8, 1, 0.875f}, {-1, 3, -0.5f}};
    const Scene scene = scene_in(file);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(glm::vec3(scene.world(scene.vertex_arrays[0].positions[i])), expected[i]) << i;
}

TEST(Meshopt, QuaternionsOfInstancesGetTheirLargestNumberBack) {
    // A quarter rotation about +Y, (0, s, 0, s): without the last number, the others times the square root of
    // 2.
    GlbFile file = test::triangle_file();
    const std::vector<std::int16_t> values = {0, 32767, 0, 32764 | 3};
    const std::size_t view = filtered_view(file, values, 8, "QUATERNION"),
                      rotation = file.json["accessors"].size();
    file.json["accessors"].push_back({{"bufferView", view},
                                      {"componentType", test::kShort},
                                      {"normalized", true},
                                      {"count", 1},
                                      {"type", "VEC4"}});
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", rotation}};
    const Scene scene = scene_in(file);
    const glm::vec3 corner(scene.world(scene.vertex_arrays[0].positions[1]));
    EXPECT_LT(glm::distance(corner, glm::vec3(0, 0, -1)), 1e-4f);
}

TEST(Meshopt, FiltersOfAnotherStrideAreRejected) {
    for (const auto& [filter, stride] : {std::pair("OCTAHEDRAL", 12), std::pair("QUATERNION", 4)}) {
        GlbFile file = test::triangle_file();
        filtered_view(file, std::vector<std::uint32_t>(12, 1), static_cast<std::size_t>(stride), filter);
        EXPECT_THROW(scene_in(file), Error) << filter;
    }
}

} // namespace
} // namespace prt
