// Writes mesh arrays as glTF, and reads OBJ with tinyobjloader.

#include "bake/gltf/mesh_file.h"

#include "bake/gltf/ply_file.h"
#include "prt/core/error.h"
#include "prt/load/scene.h"
#include "runtime/load/glb.h"
#include "runtime/load/gltf_model.h"
#include "runtime/load/json.h"
#include "runtime/load/srgb.h"

#define TINYOBJLOADER_IMPLEMENTATION // with doubles, so that coordinates of maps keep their precision
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace prt {
namespace {

constexpr std::size_t kMaxMeshVertices = (std::size_t{1} << 32) - 1; ///< glTF reserves the largest index

/// Builds the JSON and the buffer of a .glb file.
class GlbBuilder {
public:
    /// Appends an array and returns the index of its accessor.
    template <class T>
    std::size_t add(std::span<const T> values, const char* type, int component, int target) {
        const auto bytes = std::as_bytes(values);
        json_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}, {"target", target}});
        data_.insert(data_.end(), bytes.begin(), bytes.end());
        const bool scalar = std::strcmp(type, "SCALAR") == 0;
        json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"count", values.size() * (scalar ? 3 : 1)},
                                      {"type", type}});
        return json_["accessors"].size() - 1;
    }
    Json& json() { return json_; }
    std::vector<std::byte> file() {
        json_["buffers"] = Json::array({{{"byteLength", data_.size()}}});
        return make_glb(json_.dump(-1, ' ', false, Json::error_handler_t::replace), data_);
    }

private:
    Json json_ = {{"asset", {{"version", "2.0"}, {"generator", "prtkit"}}}};
    std::vector<std::byte> data_;
};

void check_length(std::size_t length, std::size_t vertices, const char* what) {
    if (length != 0 && length != vertices)
        throw Error("has " + std::to_string(length) + " " + what + ", but " + std::to_string(vertices) +
                    " vertices");
}

void check_mesh(const MeshArrays& mesh) {
    const std::size_t vertices = mesh.positions.size();
    if (vertices == 0 || mesh.triangles.empty())
        throw Error(vertices == 0 ? "has no vertices" : "has no triangles");
    if (vertices > kMaxMeshVertices)
        throw Error("has more than 2^32 - 1 vertices");
    check_length(mesh.normals.size(), vertices, "normals");
    check_length(mesh.colors.size(), vertices, "colors");
    check_length(mesh.texcoords.size(), vertices, "texture coordinates");
    for (std::size_t v = 0; v < vertices; ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.positions[v][axis]) <= kFarthestVertex))
                throw Error("the position of vertex " + std::to_string(v) +
                            " is not finite or exceeds 1e9 metres");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (mesh.triangles[t][corner] >= vertices)
                throw Error("triangle " + std::to_string(t) + " refers to vertex " +
                            std::to_string(mesh.triangles[t][corner]) + ", but there are only " +
                            std::to_string(vertices));
}

/// Builds a mesh of the corners of an OBJ file. Corners with equal indices are one vertex.
class ObjMesh {
public:
    explicit ObjMesh(const tinyobj::ObjReader& reader) : attributes_(reader.GetAttrib()) {
        const std::vector<tinyobj::shape_t>& shapes = reader.GetShapes();
        normals_ = texcoords_ = true;
        for (const tinyobj::shape_t& shape : shapes)
            for (const tinyobj::index_t& corner : shape.mesh.indices) {
                normals_ = normals_ && corner.normal_index >= 0;
                texcoords_ = texcoords_ && corner.texcoord_index >= 0;
            }
        if (!normals_ && !texcoords_) // all vertices of the file, in their order
            for (std::size_t v = 0; v < attributes_.vertices.size() / 3; ++v)
                vertex({static_cast<int>(v), -1, -1});
        for (const tinyobj::shape_t& shape : shapes)
            for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3)
                mesh.triangles.emplace_back(vertex(shape.mesh.indices[i]), vertex(shape.mesh.indices[i + 1]),
                                            vertex(shape.mesh.indices[i + 2]));
    }
    MeshArrays mesh;

private:
    std::uint32_t vertex(const tinyobj::index_t& corner) {
        const std::array<int, 3> key = {corner.vertex_index, normals_ ? corner.normal_index : -1,
                                        texcoords_ ? corner.texcoord_index : -1};
        const auto [found, is_new] =
            index_.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        if (!is_new)
            return found->second;
        const auto v = 3 * static_cast<std::size_t>(key[0]), n = 3 * static_cast<std::size_t>(key[1]),
                   t = 2 * static_cast<std::size_t>(key[2]);
        const auto& a = attributes_;
        mesh.positions.emplace_back(a.vertices.at(v), a.vertices.at(v + 1), a.vertices.at(v + 2));
        if (a.colors.size() == a.vertices.size())
            mesh.colors.emplace_back(srgb_to_linear(a.colors[v]), srgb_to_linear(a.colors[v + 1]),
                                     srgb_to_linear(a.colors[v + 2]));
        if (normals_)
            mesh.normals.emplace_back(a.normals.at(n), a.normals.at(n + 1), a.normals.at(n + 2));
        if (texcoords_)
            mesh.texcoords.emplace_back(a.texcoords.at(t), 1 - a.texcoords.at(t + 1));
        return found->second;
    }
    const tinyobj::attrib_t& attributes_;
    bool normals_ = false, texcoords_ = false;
    std::map<std::array<int, 3>, std::uint32_t> index_;
};

MeshArrays read_obj(std::span<const std::byte> file) {
    tinyobj::ObjReaderConfig how;
    how.triangulate = true;
    how.vertex_color = false; // no colors where the file has none
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString({reinterpret_cast<const char*>(file.data()), file.size()}, "", how))
        throw Error("cannot be read: " + one_line(reader.Error()));
    return std::move(ObjMesh(reader).mesh);
}

std::string suffix(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

} // namespace

std::vector<std::byte> mesh_glb(const MeshArrays& mesh, const std::string& name) {
    check_mesh(mesh);
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 middle = low + (high - low) / 2.0;
    std::vector<glm::vec3> positions;
    for (const glm::dvec3& p : mesh.positions)
        positions.emplace_back(p - middle);
    GlbBuilder glb;
    Json attributes = {
        {"POSITION", glb.add(std::span<const glm::vec3>(positions), "VEC3", kFloat, kArrayBuffer)}};
    if (!mesh.normals.empty())
        attributes["NORMAL"] = glb.add(std::span(mesh.normals), "VEC3", kFloat, kArrayBuffer);
    if (!mesh.colors.empty())
        attributes["COLOR_0"] = glb.add(std::span(mesh.colors), "VEC3", kFloat, kArrayBuffer);
    if (!mesh.texcoords.empty())
        attributes["TEXCOORD_0"] = glb.add(std::span(mesh.texcoords), "VEC2", kFloat, kArrayBuffer);
    Json& json = glb.json();
    const std::size_t indices =
        glb.add(std::span(mesh.triangles), "SCALAR", kUnsignedInt, kElementArrayBuffer);
    const glm::vec3 least(low - middle), most(high - middle);
    json["accessors"][0]["min"] = {least.x, least.y, least.z};
    json["accessors"][0]["max"] = {most.x, most.y, most.z};
    json["materials"] = Json::array({{{"name", name},
                                      {"doubleSided", mesh.double_sided},
                                      {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
    json["meshes"] =
        Json::array({{{"name", name},
                      {"primitives",
                       Json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}}})}}});
    json["nodes"] =
        Json::array({{{"name", name}, {"mesh", 0}, {"translation", {middle.x, middle.y, middle.z}}}});
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["scene"] = 0;
    return glb.file();
}

bool is_mesh_file(const std::filesystem::path& path) {
    const std::string end = suffix(path);
    return end == ".obj" || end == ".ply";
}

MeshArrays read_mesh_file(std::span<const std::byte> file, const std::filesystem::path& path,
                          std::vector<std::string>& notices) {
    MeshArrays mesh = suffix(path) == ".ply" ? read_ply(file) : read_obj(file);
    if (!mesh.texcoords.empty())
        notices.emplace_back("its materials and textures are not read; export glTF to bake their colors");
    mesh.double_sided = true; // these formats do not say which sides are visible
    return mesh;
}

} // namespace prt
