// Tests KHR_draco_mesh_compression: meshes compressed by Draco's encoder against the original meshes.

#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>

namespace prt {
namespace {

using draco::GeometryAttribute;
using test::GlbFile;

/// A bumpy square of size x size quads.
struct Grid {
    std::vector<float> positions, normals, texcoords, weights, deltas;
    std::vector<std::uint16_t> joints;
    std::vector<std::uint32_t> indices;

    explicit Grid(std::uint32_t size) {
        for (std::uint32_t y = 0; y <= size; ++y)
            for (std::uint32_t x = 0; x <= size; ++x) {
                const float u = static_cast<float>(x) / static_cast<float>(size),
                            v = static_cast<float>(y) / static_cast<float>(size);
                const glm::vec3 normal = glm::normalize(glm::vec3(u - 0.5f, 1, v * v));
                positions.insert(positions.end(), {u, 0.2f * std::sin(5 * u) * v, v});
                normals.insert(normals.end(), {normal.x, normal.y, normal.z});
                texcoords.insert(texcoords.end(), {v, u});
                joints.insert(joints.end(), {0, 1, 0, 0});
                weights.insert(weights.end(), {1 - u, u, 0, 0});
                deltas.insert(deltas.end(), {0, u * v, 0});
            }
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                const std::uint32_t a = y * (size + 1) + x, b = a + size + 1;
                indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
            }
    }
    std::size_t vertices() const { return positions.size() / 3; }
};

/// Ids of attributes in the compressed meshes: neither in glTF's order nor from 0 on.
constexpr int kNormalId = 7, kTexcoordId = 3, kJointsId = 11, kWeightsId = 12, kPositionId = 5;

struct Coding {
    int method = draco::MESH_EDGEBREAKER_ENCODING;
    int bits = 0; ///< bits of quantised positions, normals and texture coordinates; 0: not quantised
};

template <class T>
void add_attribute(draco::Mesh& mesh, GeometryAttribute::Type type, int id, draco::DataType data_type,
                   std::int8_t components, const std::vector<T>& values) {
    GeometryAttribute attribute;
    attribute.Init(type, nullptr, components, data_type, false,
                   static_cast<std::int64_t>(sizeof(T)) * components, 0);
    const int at = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(at)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              &values[i * static_cast<std::size_t>(components)]);
    mesh.attribute(at)->set_unique_id(static_cast<std::uint32_t>(id));
}

std::vector<std::byte> compressed(const Grid& grid, const Coding& coding) {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(grid.vertices()));
    for (std::size_t i = 0; i < grid.indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                      draco::PointIndex(grid.indices[i + 2])});
    add_attribute(mesh, GeometryAttribute::NORMAL, kNormalId, draco::DT_FLOAT32, 3, grid.normals);
    add_attribute(mesh, GeometryAttribute::TEX_COORD, kTexcoordId, draco::DT_FLOAT32, 2, grid.texcoords);
    add_attribute(mesh, GeometryAttribute::GENERIC, kJointsId, draco::DT_UINT16, 4, grid.joints);
    add_attribute(mesh, GeometryAttribute::GENERIC, kWeightsId, draco::DT_FLOAT32, 4, grid.weights);
    add_attribute(mesh, GeometryAttribute::POSITION, kPositionId, draco::DT_FLOAT32, 3, grid.positions);
    draco::Encoder encoder;
    encoder.SetEncodingMethod(coding.method);
    for (const auto type :
         {GeometryAttribute::POSITION, GeometryAttribute::NORMAL, GeometryAttribute::TEX_COORD})
        encoder.SetAttributeQuantization(type, coding.bits);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    const auto* begin = reinterpret_cast<const std::byte*>(buffer.data());
    return {begin, begin + buffer.size()};
}

nlohmann::ordered_json& first_primitive(GlbFile& file) {
    return file.json["meshes"][0]["primitives"][0];
}

/// The grid with plain accessors, under two joints the second of which is 1 m above the first.
GlbFile plain_file(const Grid& grid) {
    GlbFile file;
    const auto position = file.accessor(grid.positions, test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, -1, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    file.json["meshes"] = {{{"primitives",
                             {{{"attributes",
                                {{"POSITION", position},
                                 {"NORMAL", file.accessor(grid.normals, test::kFloat, "VEC3", 3)},
                                 {"TEXCOORD_0", file.accessor(grid.texcoords, test::kFloat, "VEC2", 2)},
                                 {"JOINTS_0", file.accessor(grid.joints, test::kUnsignedShort, "VEC4", 4)},
                                 {"WEIGHTS_0", file.accessor(grid.weights, test::kFloat, "VEC4", 4)}}},
                               {"indices", file.accessor(grid.indices, test::kUnsignedInt, "SCALAR", 1)}}}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"name", "low"}}, {{"translation", {0, 1, 0}}}};
    file.json["skins"] = {{{"joints", {1, 2}}}};
    file.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
    file.json["scene"] = 0;
    return file;
}

GlbFile draco_file(const Grid& grid, const Coding& coding) {
    GlbFile file = plain_file(grid);
    file.binary.clear();
    file.json.erase("bufferViews");
    for (auto& accessor : file.json["accessors"])
        accessor.erase("bufferView");
    first_primitive(file)["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.view(compressed(grid, coding))},
        {"attributes",
         {{"POSITION", kPositionId},
          {"NORMAL", kNormalId},
          {"TEXCOORD_0", kTexcoordId},
          {"JOINTS_0", kJointsId},
          {"WEIGHTS_0", kWeightsId}}}};
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        file.json[list] = {"KHR_draco_mesh_compression"};
    return file;
}

Scene draco_scene(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return extract_scene(parse_gltf(std::as_bytes(std::span(bytes)), "memory.glb"));
}

/// Returns the vertex of `vertices` whose texture coordinates are nearest to `texcoord`, because they
/// identify vertices.
std::uint32_t nearest_vertex(const VertexArray& vertices, const glm::vec2& texcoord) {
    const auto& set = vertices.texcoords[0];
    return static_cast<std::uint32_t>(std::min_element(set.begin(), set.end(),
                                                       [&](const glm::vec2& a, const glm::vec2& b) {
                                                           return glm::distance(a, texcoord) <
                                                                  glm::distance(b, texcoord);
                                                       }) -
                                      set.begin());
}

/// Returns triangles by vertices, rotated so that the smallest index is first.
std::multiset<std::array<std::uint32_t, 3>> triangles_of(const Primitive& primitive,
                                                         const std::vector<std::uint32_t>& vertex) {
    std::multiset<std::array<std::uint32_t, 3>> triangles;
    for (const glm::uvec3& t : primitive.triangles) {
        std::array corners{vertex[t.x], vertex[t.y], vertex[t.z]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.insert(corners);
    }
    return triangles;
}

TEST(Draco, RoundTripsWithinItsQuantization) {
    const Grid grid(12);
    const Scene plain = draco_scene(plain_file(grid));
    const VertexArray& truth = plain.vertex_arrays[0];
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING})
        for (const int bits : {0, 10, 14}) {
            const Scene scene = draco_scene(draco_file(grid, {method, bits}));
            const VertexArray& vertices = scene.vertex_arrays[0];
            ASSERT_EQ(vertices.size(), truth.size());
            // Half a step of the largest extent, which is 1; directions have an equal number of steps in two
            // dimensions.
            const float step = bits == 0 ? 0.0f : 1.0f / static_cast<float>((1 << bits) - 1);
            std::vector<std::uint32_t> vertex;
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                vertex.push_back(nearest_vertex(truth, vertices.texcoords[0][i]));
                const glm::vec3 error(scene.world(vertices.positions[i]) -
                                      plain.world(truth.positions[vertex[i]]));
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(std::abs(error[axis]), 0.5f * step + 1e-6f);
                EXPECT_LE(glm::distance(vertices.normals[i], truth.normals[vertex[i]]), 4 * step + 1e-6f);
            }
            EXPECT_EQ(std::set(vertex.begin(), vertex.end()).size(), truth.size());
            std::vector<std::uint32_t> same(truth.size());
            std::iota(same.begin(), same.end(), 0u);
            EXPECT_EQ(triangles_of(scene.primitives[0], vertex), triangles_of(plain.primitives[0], same));
        }
}

TEST(Draco, SupportsMorphTargetsWithEqualVertexOrder) {
    const Grid grid(9);
    GlbFile plain = plain_file(grid), packed = draco_file(grid, {draco::MESH_SEQUENTIAL_ENCODING, 0});
    for (GlbFile* file : {&plain, &packed}) {
        first_primitive(*file)["targets"] = {
            {{"POSITION", file->accessor(grid.deltas, test::kFloat, "VEC3", 3)}}};
        file->json["meshes"][0]["weights"] = {0.5};
    }
    const Scene a = draco_scene(plain), b = draco_scene(packed);
    EXPECT_EQ(a.vertex_arrays[0].positions, b.vertex_arrays[0].positions);
    EXPECT_EQ(a.vertex_arrays[0].normals, b.vertex_arrays[0].normals);
}

TEST(Draco, IsSavedUncompressedWithoutTheOldBytes) {
    const Grid grid(20);
    const test::TemporaryFolder folder;
    GlbFile file = draco_file(grid, {});
    const std::string picture = "not a picture, but nobody looks";
    file.json["images"] = {
        {{"mimeType", "image/png"}, {"bufferView", file.view(std::as_bytes(std::span(picture)))}}};
    file.write(folder / "packed.glb");
    const GltfDocument document = load_gltf(folder / "packed.glb");
    const Scene scene = extract_scene(document);
    save_glb(document, folder / "plain.glb");
    std::ifstream stream(folder / "plain.glb", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(bytes.find("DRACO"), std::string::npos);
    EXPECT_EQ(bytes.find("KHR_draco"), std::string::npos);
    EXPECT_NE(bytes.find(picture), std::string::npos);
    const Scene again = extract_scene(load_gltf(folder / "plain.glb"));
    EXPECT_EQ(again.vertex_arrays[0].positions, scene.vertex_arrays[0].positions);
    EXPECT_EQ(again.vertex_arrays[0].texcoords, scene.vertex_arrays[0].texcoords);
    EXPECT_EQ(again.primitives[0].triangles, scene.primitives[0].triangles);
}

TEST(Draco, SharedDataIsDecodedForEveryPrimitive) {
    GlbFile file = draco_file(Grid(5), {});
    const auto other = file.view(compressed(Grid(8), {}));
    auto same = first_primitive(file), different = first_primitive(file);
    different["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = other; // for the same accessors
    file.json["meshes"][0]["primitives"].push_back(same);
    file.json["meshes"][0]["primitives"].push_back(different);
    const Scene scene = draco_scene(file), small = draco_scene(draco_file(Grid(5), {})),
                large = draco_scene(draco_file(Grid(8), {}));
    ASSERT_EQ(scene.primitives.size(), 3u);
    EXPECT_EQ(scene.vertex_arrays.size(), 2u);
    for (const int i : {0, 1}) {
        const Primitive& p = scene.primitives[static_cast<std::size_t>(i)];
        EXPECT_EQ(p.triangles, small.primitives[0].triangles);
        EXPECT_EQ(scene.vertex_arrays[p.vertices].positions, small.vertex_arrays[0].positions);
    }
    EXPECT_EQ(scene.primitives[2].triangles, large.primitives[0].triangles);
    EXPECT_EQ(scene.vertex_arrays[scene.primitives[2].vertices].positions, large.vertex_arrays[0].positions);
}

TEST(Draco, UncompressedDataIsUsedIfTheExtensionIsOptional) {
    const Grid grid(6);
    GlbFile file = plain_file(grid);
    first_primitive(file)["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.view(compressed(grid, {.bits = 4}))},
        {"attributes", {{"POSITION", kPositionId}}}};
    file.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    EXPECT_EQ(draco_scene(file).vertex_arrays[0].positions,
              draco_scene(plain_file(grid)).vertex_arrays[0].positions);
}

/// Returns the error message of `file`; empty if it is read.
std::string message_of(const GlbFile& file) {
    try {
        draco_scene(file);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(Draco, DamageNamesThePrimitive) {
    const Grid grid(4);
    const GlbFile good = draco_file(grid, {});
    ASSERT_EQ(message_of(good), "");
    const auto broken = [&](const char* expected, const auto& change) {
        GlbFile file = good;
        change(file, first_primitive(file)["extensions"]["KHR_draco_mesh_compression"]);
        const std::string message = message_of(file);
        EXPECT_TRUE(message.starts_with("memory.glb: mesh 0 primitive 0: ")) << message;
        EXPECT_NE(message.find(expected), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    };
    broken("no attribute 99", [](GlbFile&, auto& extension) { extension["attributes"]["POSITION"] = 99; });
    broken("components", [](GlbFile&, auto& extension) { extension["attributes"]["NORMAL"] = kTexcoordId; });
    broken("buffer view 40 does not exist", [](GlbFile&, auto& extension) { extension["bufferView"] = 40; });
    broken("uncompressed attribute COLOR_0 has 3", [](GlbFile& file, auto&) {
        first_primitive(file)["attributes"]["COLOR_0"] =
            file.accessor(std::vector<float>(9, 0.5f), test::kFloat, "VEC3", 3);
    });
}

TEST(Draco, EveryTruncationIsRejected) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        GlbFile file = draco_file(Grid(3), {method, 11});
        const std::size_t size = file.json["bufferViews"][0]["byteLength"];
        for (std::size_t length = 0; length < size; ++length) {
            file.json["bufferViews"][0]["byteLength"] = length;
            EXPECT_NE(message_of(file), "") << length << " of " << size << " bytes";
        }
    }
}

TEST(Draco, ClaimsBeyondTheDataAreRejectedBeforeAllocation) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        GlbFile file = draco_file(Grid(3), {method, 11});
        // After the header of 11 bytes: the traversal method, and the number of vertices (16), then that of
        // triangles (18), seven bits per byte.
        const std::size_t at = method == draco::MESH_EDGEBREAKER_ENCODING ? 13 : 11;
        ASSERT_EQ(file.binary[at], std::byte{18});
        const std::byte many[] = {std::byte{0xff}, std::byte{0xff}, std::byte{0xff}, std::byte{0xff},
                                  std::byte{0x04}};
        file.binary.erase(file.binary.begin() + static_cast<std::ptrdiff_t>(at));
        file.binary.insert(file.binary.begin() + static_cast<std::ptrdiff_t>(at), std::begin(many),
                           std::end(many));
        file.json["bufferViews"][0]["byteLength"] = file.binary.size();
        EXPECT_NE(message_of(file).find("claims 1342177279 triangles"), std::string::npos)
            << message_of(file);
    }
}

TEST(Draco, FlippedBytesNeverCrash) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const GlbFile good = draco_file(Grid(3), {method, 11});
        std::size_t refused = 0;
        constexpr unsigned kFlips[] = {0x01, 0x80, 0xff};
        for (std::size_t i = 0; i < good.binary.size(); ++i) {
            GlbFile file = good;
            file.binary[i] ^= static_cast<std::byte>(kFlips[i % 3]);
            refused += !message_of(file).empty(); // values alone may change without a trace
        }
        EXPECT_GT(refused, good.binary.size() / 12);
    }
}

} // namespace
} // namespace prt
