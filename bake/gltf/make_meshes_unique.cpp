// Creates a separate mesh for every node, and primitives without normals flat ones, as in the extracted
// scene.
#include "bake/gltf/make_meshes_unique.h"

#include "bake/gltf/gathered_accessor.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/json_text.h"
#include "runtime/load/triangle_normal.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace prt {
namespace {

bool is_changed(const Scene& scene, const Primitive& primitive, ChangedMeshes changed) {
    return changed == ChangedMeshes::all || scene.vertex_arrays[primitive.vertices].lobes;
}

/// Copies meshes of `changed` nodes that more than one node uses; returns the new mesh index of each node.
std::map<int, std::size_t> copy_shared_meshes(GltfContents& contents, const Scene& scene,
                                              ChangedMeshes changed) {
    Json& json = contents.json;
    std::map<int, std::size_t> mesh_of_node;
    std::map<int, double> taken; // meshes that have a node, and the bytes of a copy
    for (const Primitive& primitive : scene.primitives)
        if (!is_changed(scene, primitive, changed)) {
            taken.try_emplace(primitive.mesh, 0.0);
            mesh_of_node[primitive.node] = static_cast<std::size_t>(primitive.mesh);
        }
    double bytes = 0;
    for (const Primitive& primitive : scene.primitives) {
        if (mesh_of_node.contains(primitive.node))
            continue;
        auto mesh = static_cast<std::size_t>(primitive.mesh);
        const auto [first, is_new] = taken.try_emplace(primitive.mesh, 0.0);
        if (!is_new) {
            if (first->second == 0)
                first->second = json_bytes(json["meshes"][mesh]);
            bytes += first->second;
            check_allowed(bytes, contents.file_bytes, "the JSON of its meshes, copied for each node,");
            Json copy = json["meshes"][mesh];
            mesh = json["meshes"].size();
            json["meshes"].push_back(std::move(copy));
            json["nodes"][static_cast<std::size_t>(primitive.node)]["mesh"] = mesh;
        }
        mesh_of_node[primitive.node] = mesh;
    }
    return mesh_of_node;
}

/// Returns face normals in the mesh's own frame. Triangles without area get an arbitrary unit normal, because
/// glTF does not allow zero normals.
std::vector<glm::vec3> flat_normals(const GltfContents& contents, const Json& position, const Scene& scene,
                                    const Primitive& primitive) {
    const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
    const std::vector<float> p = read_floats(contents.model, position.get<int>(), 3);
    const auto at = [&](std::uint32_t vertex) {
        const std::size_t i = 3 * std::size_t{vertices.source[vertex]};
        return glm::dvec3(p[i], p[i + 1], p[i + 2]);
    };
    std::vector<glm::vec3> normals(vertices.size(), glm::vec3(0, 0, 1));
    for (const glm::uvec3& t : primitive.triangles) {
        const glm::vec3 normal =
            unit_or_zero(area_normal(at(t.x), at(t.y), at(t.z)) * (primitive.mirrored ? -1.0 : 1.0));
        if (normal != glm::vec3(0))
            for (int corner = 0; corner < 3; ++corner)
                normals[t[corner]] = normal;
    }
    return normals;
}

/// Returns the triangles with the winding order of the file, which extraction reverses for mirrored nodes.
std::vector<glm::uvec3> in_file_order(const Primitive& primitive) {
    std::vector<glm::uvec3> triangles = primitive.triangles;
    if (primitive.mirrored)
        for (glm::uvec3& t : triangles)
            std::swap(t.y, t.z);
    return triangles;
}

} // namespace

void replace_vertices(GltfContents& contents, Json& primitive, const std::vector<std::uint32_t>& source,
                      std::span<const glm::vec3> normals, std::span<const glm::uvec3> triangles) {
    const auto gathered = [&](const Json& old, bool with_normals) {
        Json attributes = Json::object();
        for (auto it = old.begin(); it != old.end(); ++it)
            if (it.key() != "TANGENT" &&
                (with_normals || it.key() != "NORMAL")) // they belong to other normals
                attributes[it.key()] = add_gathered_accessor(contents, *it, source);
        return attributes;
    };
    Json attributes = gathered(primitive["attributes"], true);
    const std::size_t view = contents.add_buffer_view(std::as_bytes(normals), sizeof(glm::vec3), true);
    attributes["NORMAL"] = contents.add_accessor(
        {{"bufferView", view}, {"componentType", kFloat}, {"count", normals.size()}, {"type", "VEC3"}});
    primitive["attributes"] = std::move(attributes);
    if (primitive.contains("targets"))
        for (Json& target : primitive["targets"])
            target = gathered(Json(target), false);
    std::vector<std::uint32_t> indices;
    for (const glm::uvec3& t : triangles)
        indices.insert(indices.end(), {t.x, t.y, t.z});
    primitive["indices"] = add_index_accessor(contents, indices);
    primitive.erase("mode");
}

std::vector<Json*> make_meshes_unique(GltfContents& contents, const Scene& scene, ChangedMeshes changed) {
    const std::map<int, std::size_t> mesh_of_node = copy_shared_meshes(contents, scene, changed);
    std::vector<Json*> result;
    for (const Primitive& primitive : scene.primitives) {
        Json& json = contents.json["meshes"][mesh_of_node.at(primitive.node)]["primitives"]
                                  [static_cast<std::size_t>(primitive.primitive)];
        if (const auto& source = scene.vertex_arrays[primitive.vertices].source;
            !source.empty() && is_changed(scene, primitive, changed))
            replace_vertices(contents, json, source,
                             flat_normals(contents, json["attributes"]["POSITION"], scene, primitive),
                             in_file_order(primitive));
        result.push_back(&json);
    }
    return result;
}

std::vector<Json*> meshes_without_transfer(GltfContents& contents, const Scene& scene,
                                           ChangedMeshes changed) {
    std::vector<Json*> primitives = make_meshes_unique(contents, scene, changed), taken;
    std::set<int> nodes;
    for (std::size_t i = 0; i < primitives.size(); ++i)
        if (is_changed(scene, scene.primitives[i], changed)) {
            taken.push_back(primitives[i]);
            nodes.insert(scene.primitives[i].node);
        }
    if (taken.size() == primitives.size()) {
        contents.remove_transfer();
        return primitives;
    }
    contents.remove_transfer_of(taken);
    for (const int node : nodes)
        if (Json& json = contents.json["nodes"][static_cast<std::size_t>(node)];
            extension_of(json, kInstancesExtension))
            erase_extension(json, kInstancesExtension);
    return primitives;
}

} // namespace prt
