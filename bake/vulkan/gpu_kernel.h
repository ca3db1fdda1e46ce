#pragma once

// A compute shader and the buffers that it works on.

#include "vulkan/gpu_buffer.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace prt {

/// Workgroups that every device takes in one direction.
inline constexpr std::size_t kMostGroups = 65535;

/// What a kernel works on, by binding. The buffers stay where they are.
struct GpuResources {
    std::map<std::uint32_t, const GpuBuffer*> buffers;
    std::map<std::uint32_t, vk::AccelerationStructureKHR> structures = {};
};

class GpuKernel {
public:
    struct Source {
        std::span<const std::uint32_t> spirv;
        std::vector<std::uint32_t> buffers = {};    ///< bindings
        std::vector<std::uint32_t> structures = {}; ///< bindings of hierarchies of the device
        std::uint32_t push_bytes = 0;
        std::map<std::uint32_t, std::uint32_t> constants = {}; ///< by their constant_id

        /// Appends all of `resources`.
        void take_bindings(const GpuResources& resources);
    };
    GpuKernel() = default;
    GpuKernel(const VulkanDevice& device, const Source& source);

    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }
    /// Runs so many workgroups. `push`: what the shader has as push constants.
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

/// The resources that a kernel works on, which it has all of. The kernel outlives it.
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
