#pragma once

// A hierarchy of triangles that the device builds and traverses itself (VK_KHR_acceleration_structure).

#include "bake/device/gpu_buffer.h"
#include "bake/device/gpu_queue.h"

#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

class AccelerationStructure {
public:
    /// A range of the triangles, opaque ones first. Shaders do not test hits of opaque triangles. If there
    /// are both kinds, the opaque ones are the first geometry and the others the second.
    struct Mesh {
        std::size_t first = 0, opaque = 0, others = 0;
    };
    struct Copy {
        std::size_t mesh = 0;
        glm::mat4x3 transform{1};
    };

    /// Builds a bottom level for each of `meshes` from their `triangles` of `positions`, and a top level with
    /// `copies`; rays report a copy by its index. Throws `Error` if the device has too little memory.
    AccelerationStructure(const VulkanDevice& device, GpuQueue& queue, std::span<const glm::vec3> positions,
                          std::span<const glm::uvec3> triangles, std::span<const Mesh> meshes,
                          std::span<const Copy> copies);

    vk::AccelerationStructureKHR handle() const { return *levels_.back(); }
    std::size_t bytes() const;

private:
    struct LevelPlan;
    void build(const VulkanDevice& device, GpuQueue& queue, std::span<LevelPlan> plans);

    std::vector<GpuBuffer> memory_;
    std::vector<vk::raii::AccelerationStructureKHR> levels_; ///< [meshes] bottom levels, then the top level
};

} // namespace prt
