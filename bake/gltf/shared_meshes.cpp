// Finds meshes that several nodes draw with rotation, translation and uniform scale.
#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/contents.h"
#include "runtime/load/even_placement.h"
#include "runtime/load/node_transforms.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <map>
#include <set>

namespace prt {
namespace {

bool is_bent(const GltfModel& model, const GltfNode& node) {
    if (node.skin >= 0)
        return true;
    for (const GltfPrimitive& primitive : model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
        if (!primitive.targets.empty())
            return true;
    return false;
}

} // namespace

std::size_t SharedMeshes::placements() const {
    std::size_t count = 0;
    for (const SharedMesh& mesh : meshes)
        count += mesh.placements.size();
    return count;
}

SharedMeshes shared_meshes(const GltfDocument& document, const Scene& scene) {
    const GltfModel& model = document.contents().model;
    std::map<int, glm::dmat4> world;
    for (const NodeTransform& transform : world_transforms(model))
        world[transform.node] = transform.world;
    struct Drawn {
        std::size_t nodes = 0, mirrored = 0, uneven = 0, bent = 0;
        SharedMesh mesh;
    };
    std::map<int, Drawn> drawn;
    std::set<int> seen;
    for (const Primitive& primitive : scene.primitives) {
        if (!seen.insert(primitive.node).second)
            continue;
        Drawn& here = drawn[primitive.mesh];
        here.mesh.mesh = primitive.mesh;
        ++here.nodes;
        const glm::dmat4& matrix = world.at(primitive.node);
        if (scene.vertex_arrays[primitive.vertices].lobes ||
            is_bent(model, model.nodes[static_cast<std::size_t>(primitive.node)]))
            ++here.bent;
        else if (const std::optional<EvenPlacement> placement = even_placement(matrix))
            here.mesh.placements.push_back({primitive.node, placement->rotation, placement->scale});
        else
            ++(glm::determinant(glm::dmat3(matrix)) < 0 ? here.mirrored : here.uneven);
    }
    SharedMeshes result;
    for (auto& [mesh, here] : drawn) {
        if (here.nodes < 2)
            continue;
        result.mirrored += here.mirrored;
        result.uneven += here.uneven;
        result.bent += here.bent;
        if (here.mesh.placements.size() >= 2)
            result.meshes.push_back(std::move(here.mesh));
    }
    return result;
}

} // namespace prt
