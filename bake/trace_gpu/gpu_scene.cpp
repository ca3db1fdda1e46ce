// Builds the hierarchy and the tables of a scene, and uploads them.

#include "bake/trace_gpu/gpu_scene.h"

#include "bake/trace_gpu/copied_triangles.h"
#include "bake/trace_gpu/wide_bvh.h"

#include <algorithm>

namespace prt {
namespace {

/// Minimum size of the stack. Private stacks of up to 32 groups stay in registers on some chips, which then
/// run fewer threads.
constexpr int kMinStack = 64;

template <class T>
GpuBuffer to_device(const VulkanDevice& device, GpuQueue& queue, const std::vector<T>& values,
                    const char* what) {
    return uploaded(device, queue, std::as_bytes(std::span(values)), what);
}

} // namespace

GpuScene::GpuScene(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene)
    : has_alpha_(scene.surfaces().traits().alpha), textured_(scene.surfaces().traits().textured) {
    if (device.traits().ray_queries)
        build_structure(device, queue, scene);
    else
        build_nodes(device, queue, scene);
}

void GpuScene::build_structure(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene) {
    const CopiedTriangles all(scene);
    opaque_ = static_cast<std::uint32_t>(all.meshes.front().opaque);
    structure_.emplace(device, queue, all.positions, all.corners, all.meshes, all.copies);
    tables_.instances = to_device(device, queue, all.instances, "the instances");
    copies_ = all.copies.size() - 1;
    upload_tables(device, queue, scene, all.slots);
    for (const CopiedTriangles::Share& share :
         all.shares) // lamps look up emissive triangles by the index in the scene
        for (std::uint32_t t = 0; t < share.count; ++t)
            alpha_.index[share.triangle + t] = alpha_.index[share.first + t];
}

void GpuScene::build_nodes(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene) {
    const std::vector<std::uint32_t> triangles = shadowing_triangles(scene);
    std::vector<glm::vec3> positions;
    for (const VertexArray& vertices : scene.scene().vertex_arrays)
        positions.insert(positions.end(), vertices.positions.begin(), vertices.positions.end());
    std::vector<glm::uvec3> corners;
    for (const std::uint32_t t : triangles)
        corners.push_back(scene.surfaces().corners(t));
    // If nothing casts a shadow: one node without children.
    const WideBvh bvh = triangles.empty() ? WideBvh{.nodes = {gpu::WideNode{}}}
                                          : build_wide_bvh(positions, corners, scene.threads());
    levels_ = bvh.depth;
    tables_.nodes = to_device(device, queue, bvh.nodes, "the nodes");
    std::vector<std::uint32_t> in_leaves;
    for (const std::uint32_t t : bvh.triangles)
        in_leaves.push_back(triangles[t]);
    upload_tables(device, queue, scene, in_leaves);
}

void GpuScene::upload_tables(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene,
                             std::span<const std::uint32_t> slots) {
    std::vector<std::uint32_t> asked(slots.begin(), slots.end());
    // Lamps that rays do not hit may also be cut out.
    for (std::uint32_t t = 0; t < scene.surfaces().triangles(); ++t)
        if (!scene.surfaces().opaque(t) && !scene.rays().is_traced(t))
            asked.push_back(t);
    alpha_ = make_alpha_tables(scene, asked);
    tables_.corners = to_device(device, queue, tagged_corners(scene, slots, alpha_), "the triangles");
    tables_.alpha_triangles = to_device(device, queue, alpha_.triangles, "the cut-out triangles");
    tables_.alpha_materials = to_device(device, queue, alpha_.materials, "the cut-out materials");
    tables_.alpha_texels = to_device(device, queue, alpha_.texels, "the cut-out textures");
}

std::size_t GpuScene::bytes() const {
    return (structure_ ? structure_->bytes() + tables_.instances.bytes() : tables_.nodes.bytes()) +
           tables_.corners.bytes() + tables_.alpha_triangles.bytes() + tables_.alpha_materials.bytes() +
           tables_.alpha_texels.bytes();
}

GpuResources GpuScene::resources() const {
    GpuResources resources{{{PRT_BINDING_CORNERS, &tables_.corners},
                            {PRT_BINDING_ALPHA_TRIANGLES, &tables_.alpha_triangles},
                            {PRT_BINDING_ALPHA_MATERIALS, &tables_.alpha_materials},
                            {PRT_BINDING_ALPHA_TEXELS, &tables_.alpha_texels}}};
    if (structure_) {
        resources.structures[PRT_BINDING_NODES] = structure_->handle();
        resources.buffers[PRT_BINDING_INSTANCES] = &tables_.instances;
    } else {
        resources.buffers[PRT_BINDING_NODES] = &tables_.nodes;
    }
    return resources;
}

std::map<std::uint32_t, std::uint32_t> GpuScene::constants() const {
    return {{PRT_CONSTANT_ALPHA, has_alpha_},
            {PRT_CONSTANT_TEXTURED, textured_},
            {PRT_CONSTANT_STACK, static_cast<std::uint32_t>(std::max(kMinStack, levels_))},
            {PRT_CONSTANT_OPAQUE, opaque_}};
}

} // namespace prt
