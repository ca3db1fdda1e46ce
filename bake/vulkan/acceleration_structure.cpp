// Builds the bottom level, and a top level with one instance of it.

#include "vulkan/acceleration_structure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

namespace prt {
namespace {

using Use = vk::BufferUsageFlagBits;

template <class T>
GpuBuffer build_input(const VulkanDevice& device, std::span<const T> values, const char* what) {
    GpuBuffer buffer(device, values.size_bytes(), GpuMemory::upload, what,
                     Use::eShaderDeviceAddress | Use::eAccelerationStructureBuildInputReadOnlyKHR);
    std::memcpy(buffer.data(), values.data(), values.size_bytes());
    return buffer;
}

} // namespace

AccelerationStructure::Level AccelerationStructure::build(
    const VulkanDevice& device, GpuQueue& queue, vk::AccelerationStructureTypeKHR type,
    std::span<const vk::AccelerationStructureGeometryKHR> geometries, std::span<const std::uint32_t> counts) {
    vk::AccelerationStructureBuildGeometryInfoKHR info(
        type, vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace,
        vk::BuildAccelerationStructureModeKHR::eBuild, {}, {}, static_cast<std::uint32_t>(geometries.size()),
        geometries.data());
    const vk::AccelerationStructureBuildSizesInfoKHR sizes =
        device.handle().getAccelerationStructureBuildSizesKHR(
            vk::AccelerationStructureBuildTypeKHR::eDevice, info,
            vk::ArrayProxy(static_cast<std::uint32_t>(counts.size()), counts.data()));
    Level level;
    level.memory = GpuBuffer(device, sizes.accelerationStructureSize, GpuMemory::device, "the hierarchy",
                             Use::eAccelerationStructureStorageKHR | Use::eShaderDeviceAddress);
    level.structure = device.handle().createAccelerationStructureKHR(
        {{}, level.memory.handle(), 0, sizes.accelerationStructureSize, type});
    const std::size_t alignment = device.traits().scratch_alignment;
    const GpuBuffer scratch(device, sizes.buildScratchSize + alignment, GpuMemory::device,
                            "building the hierarchy", Use::eShaderDeviceAddress);
    info.dstAccelerationStructure = *level.structure;
    info.scratchData.deviceAddress = (scratch.address(device) + alignment - 1) / alignment * alignment;
    std::vector<vk::AccelerationStructureBuildRangeInfoKHR> ranges;
    for (const std::uint32_t count : counts)
        ranges.emplace_back(count, 0, 0, 0);
    queue.wait(queue.submit([&](const vk::raii::CommandBuffer& commands) {
        commands.buildAccelerationStructuresKHR(info, ranges.data());
        const vk::MemoryBarrier built(vk::AccessFlagBits::eAccelerationStructureWriteKHR,
                                      vk::AccessFlagBits::eAccelerationStructureReadKHR);
        commands.pipelineBarrier(vk::PipelineStageFlagBits::eAccelerationStructureBuildKHR,
                                 vk::PipelineStageFlagBits::eAccelerationStructureBuildKHR |
                                     vk::PipelineStageFlagBits::eComputeShader,
                                 {}, built, {}, {});
    }));
    return level;
}

AccelerationStructure::AccelerationStructure(const VulkanDevice& device, GpuQueue& queue,
                                             std::span<const glm::vec3> positions,
                                             std::span<const glm::uvec3> triangles, std::size_t opaque) {
    const std::uint64_t most =
        std::min<std::uint64_t>(device.traits().most_triangles, std::numeric_limits<std::uint32_t>::max());
    if (triangles.size() > most)
        throw Error(
            fmt::format("the scene is too large for this GPU: {} triangles, and its hierarchies have at "
                        "most {}",
                        triangles.size(), most));
    const GpuBuffer vertices = build_input(device, positions, "the vertices"),
                    corners = build_input(device, triangles, "the triangles");
    using Flag = vk::GeometryFlagBitsKHR;
    const auto geometry = [&](std::size_t first, Flag flag) -> vk::AccelerationStructureGeometryKHR {
        const vk::AccelerationStructureGeometryTrianglesDataKHR data(
            vk::Format::eR32G32B32Sfloat, vertices.address(device), sizeof(glm::vec3),
            static_cast<std::uint32_t>(std::max<std::size_t>(positions.size(), 1) - 1),
            vk::IndexType::eUint32, corners.address(device) + first * sizeof(glm::uvec3));
        return {vk::GeometryTypeKHR::eTriangles, data, flag};
    };
    const vk::AccelerationStructureGeometryKHR geometries[] = {
        geometry(0, Flag::eOpaque), geometry(opaque, Flag::eNoDuplicateAnyHitInvocation)};
    const std::uint32_t counts[] = {static_cast<std::uint32_t>(opaque),
                                    static_cast<std::uint32_t>(triangles.size() - opaque)};
    bottom_ = build(device, queue, vk::AccelerationStructureTypeKHR::eBottomLevel, geometries, counts);

    vk::AccelerationStructureInstanceKHR instance;
    for (std::size_t i = 0; i < 3; ++i)
        instance.transform.matrix[i][i] = 1;
    instance.mask = 0xff;
    instance.accelerationStructureReference =
        device.handle().getAccelerationStructureAddressKHR({*bottom_.structure});
    const GpuBuffer instances = build_input(
        device, std::span<const vk::AccelerationStructureInstanceKHR>(&instance, 1), "the instances");
    const vk::AccelerationStructureGeometryInstancesDataKHR instance_data(false, instances.address(device));
    const vk::AccelerationStructureGeometryKHR top(vk::GeometryTypeKHR::eInstances, instance_data);
    const std::uint32_t one = 1;
    top_ = build(device, queue, vk::AccelerationStructureTypeKHR::eTopLevel, {&top, 1}, {&one, 1});
}

} // namespace prt
