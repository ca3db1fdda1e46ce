// Computes areas of meshes with shared transfer over all their instances.
#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/contents.h"
#include "bake/gltf/write_set.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/node_transforms.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <map>
#include <string>

namespace prt {
namespace {

/// Maximum ratio of the area of all instances of a mesh to the mesh itself.
constexpr double kMaxArea = 1e18;

/// Returns the sum of the area factors of a node's instances relative to the node.
double area_of_instances(const GltfContents& contents, const Json& node) {
    const Json* extension = extension_of(node, kInstancingExtension);
    if (!extension)
        return 1;
    const Json& attributes = extension->at("attributes");
    if (attributes.contains("SCALE")) {
        double sum = 0;
        const std::vector<float> scales = read_floats(contents.model, attributes["SCALE"].get<int>(), 3);
        for (std::size_t i = 0; i + 2 < scales.size(); i += 3)
            sum += static_cast<double>(scales[i]) * static_cast<double>(scales[i]); // the scale is uniform
        return sum;
    }
    for (const auto& item : attributes.items())
        return static_cast<double>(contents.model.accessors.at(item.value().get<std::size_t>()).count);
    return 0;
}

/// Returns the area factor of each mesh, by the node that draws it in its own frame.
std::map<int, double> areas_of_meshes(const GltfContents& contents) {
    std::map<int, double> of_node, of_stand_in;
    for (const NodeTransform& transform : world_transforms(contents.model))
        of_node[transform.node] = std::pow(std::abs(glm::determinant(glm::dmat3(transform.world))), 2.0 / 3);
    for (const DeduplicatedMesh& separate : contents.separate)
        for (const std::size_t drawer : separate.drawers)
            if (const auto found = of_node.find(static_cast<int>(drawer)); found != of_node.end())
                of_stand_in[static_cast<int>(separate.stand_in)] +=
                    found->second * area_of_instances(contents, contents.json["nodes"][drawer]);
    for (const auto& [node, area] : of_stand_in)
        if (!(area <= kMaxArea))
            throw Error("instances of the mesh of node " + std::to_string(node) +
                        " are too large: their scale exceeds 1e9");
    return of_stand_in;
}

} // namespace

std::vector<float> instanced_areas(const GltfDocument& document, const Scene& stored) {
    return named(document, [&](const GltfContents& contents) {
        std::vector<float> areas = receiver_areas(stored);
        const std::map<int, double> of_meshes = areas_of_meshes(contents);
        std::vector<bool> seen(stored.vertex_arrays.size());
        for (const Primitive& primitive : stored.primitives) {
            const auto found = of_meshes.find(primitive.node);
            if (found == of_meshes.end() || seen[primitive.vertices])
                continue;
            seen[primitive.vertices] = true;
            const VertexArray& vertices = stored.vertex_arrays[primitive.vertices];
            for (std::size_t v = 0; v < vertices.size(); ++v)
                areas[vertices.first_receiver + v] *= static_cast<float>(found->second);
        }
        return areas;
    });
}

} // namespace prt
