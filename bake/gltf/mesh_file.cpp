// Writes mesh arrays as glTF.

#include "bake/gltf/mesh_file.h"

#include "bake/gltf/obj_file.h"
#include "bake/gltf/ply_file.h"
#include "prt/core/error.h"
#include "prt/load/scene.h"
#include "runtime/load/glb.h"
#include "runtime/load/gltf_model.h"
#include "runtime/load/json.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
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

template <class Vector>
void check_finite(const std::vector<Vector>& values, float limit, const char* what) {
    for (std::size_t v = 0; v < values.size(); ++v)
        for (int axis = 0; axis < Vector::length(); ++axis)
            if (!(std::abs(values[v][axis]) <= limit))
                throw Error(std::string("the ") + what + " of vertex " + std::to_string(v) +
                            " is not finite or is too large");
}

std::string suffix(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

} // namespace

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
    check_finite(mesh.normals, 1e30f, "normal");
    check_finite(mesh.colors, 1e6f, "color");
    check_finite(mesh.texcoords, 1e6f, "texture coordinate");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (mesh.triangles[t][corner] >= vertices)
                throw Error("triangle " + std::to_string(t) + " refers to vertex " +
                            std::to_string(mesh.triangles[t][corner]) + ", but there are only " +
                            std::to_string(vertices));
}

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
    check_mesh(mesh);
    mesh.double_sided = true; // these formats do not say which sides are visible
    return mesh;
}

} // namespace prt
