// Builds a bottom level for each mesh, and a top level of their copies.

#include "vulkan/acceleration_structure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace prt {
namespace {

using BufferUse = vk::BufferUsageFlagBits;
using GeometryFlag = vk::GeometryFlagBitsKHR;

template <class T>
GpuBuffer build_input(const VulkanDevice& device, std::span<const T> values, const char* what) {
    GpuBuffer buffer(device, values.size_bytes(), GpuMemory::upload, what,
                     BufferUse::eShaderDeviceAddress |
                         BufferUse::eAccelerationStructureBuildInputReadOnlyKHR);
    std::memcpy(buffer.data(), values.data(), values.size_bytes());
    return buffer;
}

vk::TransformMatrixKHR rows_of(const glm::mat4x3& columns) {
    vk::TransformMatrixKHR rows;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            rows.matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
                columns[column][row];
    return rows;
}

void check_limits(const VulkanDevice& device, std::size_t triangles, std::size_t copies) {
    const auto most_triangles =
        std::min<std::uint64_t>(device.traits().most_triangles, std::numeric_limits<std::uint32_t>::max());
    if (triangles > most_triangles)
        throw Error(
            fmt::format("the scene is too large for this GPU: {} triangles, and its hierarchies have at "
                        "most {}",
                        triangles, most_triangles));
    if (copies > device.traits().most_instances)
        throw Error(
            fmt::format("the scene is too large for this GPU: {} instances, and its hierarchies have at "
                        "most {}",
                        copies, device.traits().most_instances));
}

} // namespace

AccelerationStructure::Level AccelerationStructure::build(const VulkanDevice& device, GpuQueue& queue,
                                                          vk::AccelerationStructureTypeKHR type,
                                                          const Input& input) {
    vk::AccelerationStructureBuildGeometryInfoKHR info(
        type, vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace,
        vk::BuildAccelerationStructureModeKHR::eBuild, {}, {},
        static_cast<std::uint32_t>(input.geometries.size()), input.geometries.data());
    std::vector<std::uint32_t> counts;
    for (const vk::AccelerationStructureBuildRangeInfoKHR& range : input.ranges)
        counts.push_back(range.primitiveCount);
    const vk::AccelerationStructureBuildSizesInfoKHR sizes =
        device.handle().getAccelerationStructureBuildSizesKHR(vk::AccelerationStructureBuildTypeKHR::eDevice,
                                                              info, counts);
    Level level;
    level.memory = GpuBuffer(device, sizes.accelerationStructureSize, GpuMemory::device, "the hierarchy",
                             BufferUse::eAccelerationStructureStorageKHR | BufferUse::eShaderDeviceAddress);
    level.structure = device.handle().createAccelerationStructureKHR(
        {{}, level.memory.handle(), 0, sizes.accelerationStructureSize, type});
    const std::size_t alignment = device.traits().scratch_alignment;
    const GpuBuffer scratch(device, sizes.buildScratchSize + alignment, GpuMemory::device,
                            "building the hierarchy", BufferUse::eShaderDeviceAddress);
    info.dstAccelerationStructure = *level.structure;
    info.scratchData.deviceAddress = (scratch.address(device) + alignment - 1) / alignment * alignment;
    queue.wait(queue.submit([&](const vk::raii::CommandBuffer& commands) {
        commands.buildAccelerationStructuresKHR(info, input.ranges.data());
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
                                             std::span<const glm::uvec3> triangles,
                                             std::span<const Mesh> meshes, std::span<const Copy> copies) {
    check_limits(device, triangles.size(), copies.size());
    const GpuBuffer vertices = build_input(device, positions, "the vertices"),
                    corners = build_input(device, triangles, "the triangles");
    const vk::AccelerationStructureGeometryTrianglesDataKHR data(
        vk::Format::eR32G32B32Sfloat, vertices.address(device), sizeof(glm::vec3),
        static_cast<std::uint32_t>(std::max<std::size_t>(positions.size(), 1) - 1), vk::IndexType::eUint32,
        corners.address(device));
    for (const Mesh& mesh : meshes) {
        Input input;
        const auto add = [&](std::size_t first, std::size_t count, GeometryFlag flag) {
            if (count == 0 && !(input.geometries.empty() && flag != GeometryFlag::eOpaque))
                return;
            input.geometries.emplace_back(vk::GeometryTypeKHR::eTriangles, data, flag);
            input.ranges.emplace_back(static_cast<std::uint32_t>(count),
                                      static_cast<std::uint32_t>(first * sizeof(glm::uvec3)), 0, 0);
        };
        add(mesh.first, mesh.opaque, GeometryFlag::eOpaque);
        add(mesh.first + mesh.opaque, mesh.others, GeometryFlag::eNoDuplicateAnyHitInvocation);
        bottom_.push_back(build(device, queue, vk::AccelerationStructureTypeKHR::eBottomLevel, input));
    }

    std::vector<vk::AccelerationStructureInstanceKHR> instances;
    for (const Copy& copy : copies) {
        vk::AccelerationStructureInstanceKHR& instance = instances.emplace_back();
        instance.transform = rows_of(copy.transform);
        instance.mask = 0xff;
        instance.accelerationStructureReference =
            device.handle().getAccelerationStructureAddressKHR({*bottom_[copy.mesh].structure});
    }
    const GpuBuffer placed = build_input(
        device, std::span<const vk::AccelerationStructureInstanceKHR>(instances), "the instances");
    Input input;
    input.geometries.emplace_back(
        vk::GeometryTypeKHR::eInstances,
        vk::AccelerationStructureGeometryInstancesDataKHR(false, placed.address(device)));
    input.ranges.emplace_back(static_cast<std::uint32_t>(instances.size()), 0, 0, 0);
    top_ = build(device, queue, vk::AccelerationStructureTypeKHR::eTopLevel, input);
}

std::size_t AccelerationStructure::bytes() const {
    std::size_t bytes = top_.memory.bytes();
    for (const Level& level : bottom_)
        bytes += level.memory.bytes();
    return bytes;
}

} // namespace prt
