#pragma once

// The triangles of a scene for the device's own hierarchy: those of each mesh once, and where its copies
// stand.

#include "prt/trace_scene.h"
#include "vulkan/acceleration_structure.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace prt {

struct InstancedTriangles {
    /// Triangles [triangle, triangle + count) of the scene are copies of those from `first` on.
    struct Share {
        std::uint32_t triangle, first, count;
    };

    explicit InstancedTriangles(const TraceScene& scene);

    std::vector<std::uint32_t>
        slots; ///< [slots] triangle of the scene: those that stand alone, then mesh by mesh
    std::vector<glm::vec3> positions;                ///< of the vertices that those have
    std::vector<glm::uvec3> corners;                 ///< [slots] among the positions
    std::vector<AccelerationStructure::Mesh> meshes; ///< the first has what stands alone
    std::vector<AccelerationStructure::Copy> copies;
    std::vector<glm::uvec2> instances; ///< [copies] as shaders/bake_query.glsl reads them
    std::vector<Share> shares;         ///< [copies but the first of each mesh]

private:
    void add_positions(const Scene& scene, const std::vector<bool>& wanted);
    void add(const TraceScene& scene, std::uint32_t triangle);

    std::vector<std::size_t> first_position_; ///< [vertex arrays]
};

} // namespace prt
