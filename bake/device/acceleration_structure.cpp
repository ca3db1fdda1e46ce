// Builds a bottom level for each mesh, and a top level with their copies.

#include "bake/device/acceleration_structure.h"

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
    const auto max_triangles =
        std::min<std::uint64_t>(device.traits().max_triangles, std::numeric_limits<std::uint32_t>::max());
    if (triangles > max_triangles)
        throw Error(fmt::format("the scene is too large for this GPU: it has {} triangles, "
                                "but the limit is {}",
                                triangles, max_triangles));
    if (copies > device.traits().max_instances)
        throw Error(fmt::format("the scene is too large for this GPU: it has {} instances, "
                                "but the limit is {}",
                                copies, device.traits().max_instances));
}

constexpr std::size_t kAlignment = 256; ///< alignment of hierarchies in a buffer, from the specification
constexpr std::size_t kBlock =
    64 << 20; ///< bytes of a buffer shared by several levels: devices support only about 4 000 allocations

std::size_t aligned(std::size_t bytes, std::size_t to) {
    return (bytes + to - 1) / to * to;
}

} // namespace

/// Build input of a level, and its memory requirements.
struct AccelerationStructure::LevelPlan {
    vk::AccelerationStructureTypeKHR type;
    std::vector<vk::AccelerationStructureGeometryKHR> geometries;
    std::vector<vk::AccelerationStructureBuildRangeInfoKHR> ranges;
    vk::AccelerationStructureBuildSizesInfoKHR sizes = {};

    vk::AccelerationStructureBuildGeometryInfoKHR info() const {
        return {type,
                vk::BuildAccelerationStructureFlagBitsKHR::ePreferFastTrace,
                vk::BuildAccelerationStructureModeKHR::eBuild,
                {},
                {},
                static_cast<std::uint32_t>(geometries.size()),
                geometries.data()};
    }
    void add(vk::GeometryTypeKHR kind, const vk::AccelerationStructureGeometryDataKHR& data,
             GeometryFlag flag, std::size_t count, std::size_t offset) {
        geometries.emplace_back(kind, data, flag);
        ranges.emplace_back(static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(offset), 0, 0);
    }
    void measure(const VulkanDevice& device) {
        std::vector<std::uint32_t> counts;
        for (const vk::AccelerationStructureBuildRangeInfoKHR& range : ranges)
            counts.push_back(range.primitiveCount);
        sizes = device.handle().getAccelerationStructureBuildSizesKHR(
            vk::AccelerationStructureBuildTypeKHR::eDevice, info(), counts);
    }
};

/// Builds levels one after another, with the minimum number of buffers.
void AccelerationStructure::build(const VulkanDevice& device, GpuQueue& queue, std::span<LevelPlan> plans) {
    std::size_t scratch_bytes = 0, end = 0;
    for (LevelPlan& plan : plans) {
        plan.measure(device);
        scratch_bytes = std::max<std::size_t>(scratch_bytes, plan.sizes.buildScratchSize);
    }
    const std::size_t alignment = device.traits().scratch_alignment;
    const GpuBuffer scratch(device, scratch_bytes + alignment, GpuMemory::device, "building the hierarchy",
                            BufferUse::eShaderDeviceAddress);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const std::size_t bytes = plans[i].sizes.accelerationStructureSize;
        if (i == 0 || end + bytes > memory_.back().bytes()) {
            std::size_t together = 0;
            for (std::size_t j = i; j < plans.size() && (j == i || together < kBlock); ++j)
                together += aligned(plans[j].sizes.accelerationStructureSize, kAlignment);
            memory_.emplace_back(device, together, GpuMemory::device, "the hierarchy",
                                 BufferUse::eAccelerationStructureStorageKHR |
                                     BufferUse::eShaderDeviceAddress);
            end = 0;
        }
        levels_.push_back(device.handle().createAccelerationStructureKHR(
            {{}, memory_.back().handle(), end, bytes, plans[i].type}));
        end = aligned(end + bytes, kAlignment);
        vk::AccelerationStructureBuildGeometryInfoKHR info = plans[i].info();
        info.dstAccelerationStructure = *levels_.back();
        info.scratchData.deviceAddress = aligned(scratch.address(device), alignment);
        queue.submit([&](const vk::raii::CommandBuffer& commands) {
            commands.buildAccelerationStructuresKHR(info, plans[i].ranges.data());
            using Access = vk::AccessFlagBits;
            using Stage = vk::PipelineStageFlagBits;
            const vk::MemoryBarrier built(Access::eAccelerationStructureWriteKHR,
                                          Access::eAccelerationStructureReadKHR |
                                              Access::eAccelerationStructureWriteKHR);
            commands.pipelineBarrier(Stage::eAccelerationStructureBuildKHR,
                                     Stage::eAccelerationStructureBuildKHR | Stage::eComputeShader, {}, built,
                                     {}, {});
        });
    }
    queue.wait_for_all(); // scratch memory is released
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
    std::vector<LevelPlan> plans;
    for (const Mesh& mesh : meshes) {
        LevelPlan& plan =
            plans.emplace_back(LevelPlan{vk::AccelerationStructureTypeKHR::eBottomLevel, {}, {}});
        if (mesh.opaque > 0)
            plan.add(vk::GeometryTypeKHR::eTriangles, data, GeometryFlag::eOpaque, mesh.opaque,
                     mesh.first * sizeof(glm::uvec3));
        if (mesh.others > 0 || mesh.opaque == 0)
            plan.add(vk::GeometryTypeKHR::eTriangles, data, GeometryFlag::eNoDuplicateAnyHitInvocation,
                     mesh.others, (mesh.first + mesh.opaque) * sizeof(glm::uvec3));
    }
    build(device, queue, plans);

    std::vector<vk::AccelerationStructureInstanceKHR> instances;
    for (const Copy& copy : copies) {
        vk::AccelerationStructureInstanceKHR& instance = instances.emplace_back();
        instance.transform = rows_of(copy.transform);
        instance.mask = 0xff;
        instance.accelerationStructureReference =
            device.handle().getAccelerationStructureAddressKHR({*levels_[copy.mesh]});
    }
    const GpuBuffer placed = build_input(
        device, std::span<const vk::AccelerationStructureInstanceKHR>(instances), "the instances");
    LevelPlan top{vk::AccelerationStructureTypeKHR::eTopLevel, {}, {}};
    top.add(vk::GeometryTypeKHR::eInstances,
            vk::AccelerationStructureGeometryInstancesDataKHR(false, placed.address(device)),
            GeometryFlag::eOpaque, instances.size(), 0);
    build(device, queue, {&top, 1});
}

std::size_t AccelerationStructure::bytes() const {
    std::size_t bytes = 0;
    for (const GpuBuffer& buffer : memory_)
        bytes += buffer.bytes();
    return bytes;
}

} // namespace prt
