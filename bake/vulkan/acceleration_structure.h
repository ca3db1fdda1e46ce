#pragma once

// A hierarchy of triangles that the device builds and traverses by itself (VK_KHR_acceleration_structure).

#include "vulkan/gpu_buffer.h"
#include "vulkan/gpu_queue.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

class AccelerationStructure {
public:
    /// Over `triangles` of `positions`: one level, below one instance. The first `opaque` triangles are its
    /// first geometry, of which shaders are not asked; the others are its second. Throws `Error` where the
    /// device has no room.
    AccelerationStructure(const VulkanDevice& device, GpuQueue& queue, std::span<const glm::vec3> positions,
                          std::span<const glm::uvec3> triangles, std::size_t opaque);

    vk::AccelerationStructureKHR handle() const { return *top_.structure; }
    std::size_t bytes() const { return bottom_.memory.bytes() + top_.memory.bytes(); }

private:
    struct Level {
        GpuBuffer memory;
        vk::raii::AccelerationStructureKHR structure = nullptr;
    };
    static Level build(const VulkanDevice& device, GpuQueue& queue, vk::AccelerationStructureTypeKHR type,
                       std::span<const vk::AccelerationStructureGeometryKHR> geometries,
                       std::span<const std::uint32_t> counts);

    Level bottom_, top_;
};

} // namespace prt
