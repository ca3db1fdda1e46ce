// Estimates the memory of vertices, indices and morph targets of all nodes.
#include "runtime/scene/gltf/scene_size.h"

#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/allowance.h"
#include "runtime/scene/gltf/triangles.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

using Attributes = std::map<std::string, int>;

// Bytes while a scene is read: per vertex its positions in float and double and its normal; per index the
// index and its share of a triangle; per primitive its data and names.
constexpr double kVertex = 64, kIndex = 8, kPrimitive = 256;

double count_of(const tinygltf::Model& model, int accessor) {
    return static_cast<double>(get_accessor(model, accessor).count);
}

/// Returns the size of an element of an attribute or morph target: four floats, or its stored size, which
/// applies if vertices are split and the new accessor is written.
double element_bytes(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = get_accessor(model, index);
    return std::max(16.0, static_cast<double>(component_bytes(accessor.componentType)) *
                              component_count(accessor.type));
}

double bytes_of_elements(const tinygltf::Model& model, const Attributes& attributes) {
    double bytes = 0;
    for (const auto& [name, accessor] : attributes)
        bytes += element_bytes(model, accessor);
    return bytes;
}

/// Returns the size of one instance of `mesh` in bytes.
double instance_bytes(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
    std::set<std::pair<Attributes, std::vector<Attributes>>> seen;
    double bytes = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        bytes += kPrimitive;
        const auto position = primitive.attributes.find("POSITION");
        if (!is_triangle_mode(primitive.mode) || position == primitive.attributes.end())
            continue;
        const double indices = primitive.indices >= 0 ? count_of(model, primitive.indices) : 0;
        double vertices = count_of(model, position->second);
        bytes += kIndex * std::max(indices, vertices);
        if (primitive.attributes.contains("NORMAL")) {
            if (!seen.emplace(primitive.attributes, primitive.targets).second)
                continue; // shared with a previous primitive
        } else {
            vertices = std::max(vertices, indices); // flat normals split them
        }
        double elements = bytes_of_elements(model, primitive.attributes);
        for (const Attributes& target : primitive.targets)
            elements += bytes_of_elements(model, target);
        bytes += vertices * (kVertex + elements);
    }
    return bytes;
}

} // namespace

void check_scene_size(const GltfContents& contents, std::span<const NodeTransform> nodes) {
    const tinygltf::Model& model = contents.model;
    std::vector<double> of_mesh;
    for (const tinygltf::Mesh& mesh : model.meshes)
        of_mesh.push_back(instance_bytes(model, mesh));
    double bytes = 0;
    for (const NodeTransform& node : nodes) {
        const int mesh = model.nodes[static_cast<std::size_t>(node.node)].mesh;
        if (node.visible && mesh >= 0 && static_cast<std::size_t>(mesh) < of_mesh.size())
            bytes += of_mesh[static_cast<std::size_t>(mesh)];
    }
    check_scene_allowed(bytes, contents, "the scene (with instances and morph targets)");
}

} // namespace prt
