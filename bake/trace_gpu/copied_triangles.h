#pragma once

// Triangles of a scene for the hierarchy of the device: each instanced mesh once, and the transforms of its
// instances.

#include "bake/device/acceleration_structure.h"
#include "bake/scene/trace_scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace prt {

struct CopiedTriangles {
    /// Marks triangles [triangle, triangle + count) of the scene as copies of the triangles from `first` on.
    struct Share {
        std::uint32_t triangle, first, count;
    };

    explicit CopiedTriangles(const TraceScene& scene);

    /// [slots] triangle of the scene: first triangles without instances, then mesh by mesh.
    std::vector<std::uint32_t> slots;
    std::vector<glm::vec3> positions;                ///< positions of the vertices of these triangles
    std::vector<glm::uvec3> corners;                 ///< [slots] indices into `positions`
    std::vector<AccelerationStructure::Mesh> meshes; ///< the first mesh has the triangles without instances
    std::vector<AccelerationStructure::Copy> copies;
    std::vector<glm::uvec2> instances; ///< [copies] in the layout of shaders/bake_query.glsl
    std::vector<Share> shares;         ///< [copies except the first of each mesh]

private:
    void add_positions(const Scene& scene, const std::vector<bool>& wanted);
    void add(const TraceScene& scene, std::uint32_t triangle);

    std::vector<std::size_t> first_position_; ///< [vertex arrays]
};

} // namespace prt
