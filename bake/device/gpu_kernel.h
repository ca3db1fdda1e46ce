#pragma once

// A compute shader and its buffers.

#include "bake/device/gpu_buffer.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace prt {

/// Number of workgroups per dimension that every device supports.
inline constexpr std::size_t kMaxGroups = 65535;

/// Resources of a kernel by binding. The buffers must not move.
struct GpuResources {
    std::map<std::uint32_t, const GpuBuffer*> buffers;
    std::map<std::uint32_t, vk::AccelerationStructureKHR> structures = {};
};

class GpuKernel {
public:
    struct Source {
        std::span<const std::uint32_t> spirv;
        std::vector<std::uint32_t> buffers = {};    ///< bindings
        std::vector<std::uint32_t> structures = {}; ///< bindings of the device's hierarchies
        std::uint32_t push_bytes = 0;
        std::map<std::uint32_t, std::uint32_t> constants = {}; ///< by constant_id

        /// Appends the bindings of all `resources`.
        void take_bindings(const GpuResources& resources);
    };
    GpuKernel() = default;
    GpuKernel(const VulkanDevice& device, const Source& source);

    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }
    /// Dispatches x · y workgroups. `push`: push constants of the shader.
    template <class Push>
    void dispatch(const vk::raii::CommandBuffer& commands, vk::DescriptorSet bindings, const Push& push,
                  std::size_t x, std::size_t y = 1) const {
        commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
        commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, bindings, {});
        commands.pushConstants<Push>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
        commands.dispatch(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 1);
    }

private:
    vk::raii::DescriptorSetLayout set_layout_ = nullptr;
    vk::raii::PipelineLayout layout_ = nullptr;
    vk::raii::Pipeline pipeline_ = nullptr;
};

/// Resources bound to a kernel, one for each of its bindings. The kernel must outlive it.
class GpuBindings {
public:
    GpuBindings() = default;
    GpuBindings(const VulkanDevice& device, const GpuKernel& kernel, const GpuResources& resources);
    vk::DescriptorSet handle() const { return set_; }

private:
    vk::raii::DescriptorPool pool_ = nullptr; // owns the set
    vk::DescriptorSet set_;
};

} // namespace prt
