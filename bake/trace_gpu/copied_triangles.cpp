// Collects triangles without instances into one mesh, and each instanced mesh into its own mesh.

#include "bake/trace_gpu/copied_triangles.h"

#include "bake/trace_gpu/alpha_tables.h"
#include "bake/trace_gpu/copies.h"

namespace prt {

CopiedTriangles::CopiedTriangles(const TraceScene& traced) {
    const Scene& scene = traced.scene();
    const Surfaces& surfaces = traced.surfaces();
    std::vector<std::uint32_t> first_triangle;
    std::uint32_t triangles = 0;
    for (const Primitive& primitive : scene.primitives) {
        first_triangle.push_back(triangles);
        triangles += static_cast<std::uint32_t>(primitive.triangles.size());
    }
    std::vector<std::vector<CopiedPrimitive>> shared = find_copies(scene);
    std::erase_if(shared, [&](const std::vector<CopiedPrimitive>& mesh) {
        return !scene.materials[scene.primitives[mesh.front().primitive].material].casts_shadow;
    });
    std::vector<bool> is_copy(scene.primitives.size()), wanted(scene.vertex_arrays.size());
    for (const std::vector<CopiedPrimitive>& mesh : shared)
        for (const CopiedPrimitive& instance : mesh)
            is_copy[instance.primitive] = true;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        wanted[scene.primitives[p].vertices] = wanted[scene.primitives[p].vertices] || !is_copy[p];
    for (const std::vector<CopiedPrimitive>& mesh : shared)
        wanted[scene.primitives[mesh.front().primitive].vertices] = true;
    add_positions(scene, wanted);

    AccelerationStructure::Mesh alone;
    for (const std::uint32_t t : shadowing_triangles(traced)) {
        if (is_copy[surfaces.primitive(t)])
            continue;
        add(traced, t);
        ++(surfaces.opaque(t) ? alone.opaque : alone.others);
    }
    meshes.push_back(alone);
    copies.push_back({});
    instances.emplace_back(0u, 0u);
    for (const std::vector<CopiedPrimitive>& mesh : shared) {
        const std::uint32_t first = first_triangle[mesh.front().primitive];
        const auto count =
            static_cast<std::uint32_t>(scene.primitives[mesh.front().primitive].triangles.size());
        const auto first_slot = static_cast<std::uint32_t>(slots.size());
        const bool opaque = count == 0 || surfaces.opaque(first);
        for (std::uint32_t t = first; t < first + count; ++t)
            if (traced.rays().is_traced(t))
                add(traced, t);
        const auto added = static_cast<std::uint32_t>(slots.size()) - first_slot;
        for (const CopiedPrimitive& instance : mesh) {
            const std::uint32_t triangle = first_triangle[instance.primitive];
            copies.push_back({meshes.size(), instance.transform});
            instances.emplace_back(first_slot, triangle - first);
            if (triangle != first)
                shares.push_back({triangle, first, count});
        }
        meshes.push_back({first_slot, opaque ? added : 0, opaque ? 0 : added});
    }
}

void CopiedTriangles::add_positions(const Scene& scene, const std::vector<bool>& wanted) {
    for (std::size_t v = 0; v < scene.vertex_arrays.size(); ++v) {
        first_position_.push_back(positions.size());
        if (wanted[v])
            positions.insert(positions.end(), scene.vertex_arrays[v].positions.begin(),
                             scene.vertex_arrays[v].positions.end());
    }
}

void CopiedTriangles::add(const TraceScene& traced, std::uint32_t triangle) {
    const std::size_t array = traced.scene().primitives[traced.surfaces().primitive(triangle)].vertices;
    slots.push_back(triangle);
    corners.push_back(traced.surfaces().corners(triangle) -
                      static_cast<unsigned>(traced.scene().vertex_arrays[array].first_receiver) +
                      static_cast<unsigned>(first_position_[array]));
}

} // namespace prt
