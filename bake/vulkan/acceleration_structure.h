#pragma once

// A hierarchy of triangles that the device builds and traverses by itself (VK_KHR_acceleration_structure).

#include "vulkan/gpu_buffer.h"
#include "vulkan/gpu_queue.h"

#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

class AccelerationStructure {
public:
    /// Triangles that stand side by side among all, the opaque ones first. Shaders are not asked about those;
    /// where there are both, they are the first geometry and the others the second.
    struct Mesh {
        std::size_t first = 0, opaque = 0, others = 0;
    };
    struct Copy {
        std::size_t mesh = 0;
        glm::mat4x3 transform{1};
    };

    /// A bottom level for each of `meshes` over their `triangles` of `positions`, and a top level with
    /// `copies`, which rays find by their place here. Throws `Error` where the device has no room.
    AccelerationStructure(const VulkanDevice& device, GpuQueue& queue, std::span<const glm::vec3> positions,
                          std::span<const glm::uvec3> triangles, std::span<const Mesh> meshes,
                          std::span<const Copy> copies);

    vk::AccelerationStructureKHR handle() const { return *levels_.back(); }
    std::size_t bytes() const;

private:
    struct LevelPlan;
    void build(const VulkanDevice& device, GpuQueue& queue, std::span<LevelPlan> plans);

    std::vector<GpuBuffer> memory_;
    std::vector<vk::raii::AccelerationStructureKHR> levels_; ///< [meshes], and the top level
};

} // namespace prt
