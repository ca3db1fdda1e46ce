// Makes the hierarchy and the tables of a scene, and uploads them.

#include "trace/gpu/gpu_scene.h"

#include "trace/gpu/wide_bvh.h"

#include <algorithm>

namespace prt {
namespace {

/// Positions of all vertices, and the corners of `triangles` among them.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> corners;

    Mesh(const TraceScene& scene, std::span<const std::uint32_t> triangles) {
        for (const VertexArray& vertices : scene.scene().vertex_arrays)
            positions.insert(positions.end(), vertices.positions.begin(), vertices.positions.end());
        for (const std::uint32_t t : triangles)
            corners.push_back(scene.surfaces().corners(t));
    }
};

/// Private stacks of up to 32 groups stay in registers on some chips, which then hold fewer threads.
constexpr int kLeastStack = 64;

} // namespace

GpuScene::GpuScene(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene)
    : has_alpha_(scene.surfaces().traits().alpha), textured_(scene.surfaces().traits().textured),
      alpha_(make_alpha_tables(scene)) {
    std::vector<std::uint32_t> triangles = shadowing_triangles(scene);
    opaque_ = static_cast<std::uint32_t>(
        std::ranges::count_if(triangles, [&](std::uint32_t t) { return scene.surfaces().opaque(t); }));
    const Mesh mesh(scene, triangles);
    const auto upload = [&]<class T>(const std::vector<T>& values, const char* what) {
        return uploaded(device, queue, std::as_bytes(std::span(values)), what);
    };
    if (device.traits().ray_queries) {
        structure_.emplace(device, queue, mesh.positions, mesh.corners, opaque_);
    } else {
        // Nothing casts a shadow: a node without children.
        const WideBvh bvh = triangles.empty() ? WideBvh{.nodes = {gpu::WideNode{}}}
                                              : build_wide_bvh(mesh.positions, mesh.corners, scene.threads());
        levels_ = bvh.depth;
        nodes_ = upload(bvh.nodes, "the nodes");
        std::vector<std::uint32_t> in_leaves;
        for (const std::uint32_t t : bvh.triangles)
            in_leaves.push_back(triangles[t]);
        triangles = std::move(in_leaves);
    }
    corners_ = upload(tagged_corners(scene, triangles, alpha_), "the triangles");
    alpha_triangles_ = upload(alpha_.triangles, "the cut-out triangles");
    alpha_materials_ = upload(alpha_.materials, "the cut-out materials");
    alpha_texels_ = upload(alpha_.texels, "the cut-out textures");
}

std::size_t GpuScene::bytes() const {
    return (structure_ ? structure_->bytes() : nodes_.bytes()) + corners_.bytes() + alpha_triangles_.bytes() +
           alpha_materials_.bytes() + alpha_texels_.bytes();
}

GpuResources GpuScene::resources() const {
    GpuResources resources{{{PRT_BINDING_CORNERS, &corners_},
                            {PRT_BINDING_ALPHA_TRIANGLES, &alpha_triangles_},
                            {PRT_BINDING_ALPHA_MATERIALS, &alpha_materials_},
                            {PRT_BINDING_ALPHA_TEXELS, &alpha_texels_}}};
    if (structure_)
        resources.structures[PRT_BINDING_NODES] = structure_->handle();
    else
        resources.buffers[PRT_BINDING_NODES] = &nodes_;
    return resources;
}

std::map<std::uint32_t, std::uint32_t> GpuScene::constants() const {
    return {{PRT_CONSTANT_ALPHA, has_alpha_},
            {PRT_CONSTANT_TEXTURED, textured_},
            {PRT_CONSTANT_STACK, static_cast<std::uint32_t>(std::max(kLeastStack, levels_))},
            {PRT_CONSTANT_OPAQUE, opaque_}};
}

} // namespace prt
