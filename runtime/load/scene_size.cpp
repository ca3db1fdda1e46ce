// Estimates the memory of vertices, indices and morph targets of all nodes.
#include "runtime/load/scene_size.h"

#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/triangles.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

// Bytes while a scene is read: per vertex its positions in float and double and its normal; per index the
// index and its share of a triangle; per primitive its data and names.
constexpr double kVertex = 64, kIndex = 8, kPrimitive = 256;

double count_of(const GltfModel& model, int accessor) {
    return static_cast<double>(get_accessor(model, accessor).count);
}

/// Returns the size of an element of an attribute or morph target: four floats, or its stored size, which
/// applies if vertices are split and the new accessor is written.
double element_bytes(const GltfModel& model, int index) {
    const GltfAccessor& accessor = get_accessor(model, index);
    return std::max(16.0, static_cast<double>(component_bytes(accessor.componentType)) * accessor.components);
}

double bytes_of_elements(const GltfModel& model, const GltfAttributes& attributes) {
    double bytes = 0;
    for (const auto& [name, accessor] : attributes)
        bytes += element_bytes(model, accessor);
    return bytes;
}

/// Returns the size of one instance of `mesh` in bytes.
double instance_bytes(const GltfModel& model, const GltfMesh& mesh) {
    std::set<std::pair<GltfAttributes, std::vector<GltfAttributes>>> seen;
    double bytes = 0;
    for (const GltfPrimitive& primitive : mesh.primitives) {
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
        for (const GltfAttributes& target : primitive.targets)
            elements += bytes_of_elements(model, target);
        bytes += vertices * (kVertex + elements);
    }
    return bytes;
}

} // namespace

void check_scene_size(const GltfData& data, std::span<const NodeTransform> nodes) {
    const GltfModel& model = data.model;
    std::vector<double> of_mesh;
    for (const GltfMesh& mesh : model.meshes)
        of_mesh.push_back(instance_bytes(model, mesh));
    double bytes = 0;
    for (const NodeTransform& node : nodes) {
        const int mesh = model.nodes[static_cast<std::size_t>(node.node)].mesh;
        if (node.visible && mesh >= 0 && static_cast<std::size_t>(mesh) < of_mesh.size())
            bytes += of_mesh[static_cast<std::size_t>(mesh)];
    }
    check_scene_allowed(bytes, data, "the scene (with instances and morph targets)");
}

} // namespace prt
