// Creates compute pipelines and their descriptor sets.

#include "bake/device/gpu_kernel.h"

namespace prt {

void GpuKernel::Source::take_bindings(const GpuResources& resources) {
    for (const auto& [binding, buffer] : resources.buffers)
        buffers.push_back(binding);
    for (const auto& [binding, structure] : resources.structures)
        structures.push_back(binding);
}

GpuKernel::GpuKernel(const VulkanDevice& device, const Source& source) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (const std::uint32_t b : source.buffers)
        bindings.emplace_back(b, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
    for (const std::uint32_t b : source.structures)
        bindings.emplace_back(b, vk::DescriptorType::eAccelerationStructureKHR, 1,
                              vk::ShaderStageFlagBits::eCompute);
    set_layout_ = device.handle().createDescriptorSetLayout({{}, bindings});
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, source.push_bytes);
    layout_ = device.handle().createPipelineLayout({{}, *set_layout_, push});
    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const auto& [constant, value] : source.constants) {
        entries.emplace_back(constant, static_cast<std::uint32_t>(values.size() * sizeof value),
                             sizeof value);
        values.push_back(value);
    }
    const vk::SpecializationInfo constants(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                           values.size() * sizeof(std::uint32_t), values.data());
    const vk::raii::ShaderModule shader(device.handle(),
                                        {{}, source.spirv.size_bytes(), source.spirv.data()});
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main",
                                                  &constants);
    pipeline_ = device.handle().createComputePipeline(nullptr, {{}, stage, *layout_});
}

GpuBindings::GpuBindings(const VulkanDevice& device, const GpuKernel& kernel, const GpuResources& resources) {
    const auto& [buffers, structures] = resources;
    std::vector<vk::DescriptorPoolSize> sizes{
        {vk::DescriptorType::eStorageBuffer, static_cast<std::uint32_t>(buffers.size())}};
    if (!structures.empty())
        sizes.emplace_back(vk::DescriptorType::eAccelerationStructureKHR,
                           static_cast<std::uint32_t>(structures.size()));
    pool_ = device.handle().createDescriptorPool({{}, 1, sizes});
    const vk::DescriptorSetLayout layout = kernel.set_layout();
    set_ =
        (*device.handle()).allocateDescriptorSets({*pool_, layout}, *device.handle().getDispatcher()).front();

    std::vector<vk::DescriptorBufferInfo> infos;
    infos.reserve(buffers.size());
    std::vector<vk::WriteDescriptorSet> writes;
    for (const auto& [binding, buffer] : buffers) {
        infos.emplace_back(buffer->handle(), 0, VK_WHOLE_SIZE);
        writes.emplace_back(set_, binding, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr, &infos.back());
    }
    std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_infos;
    structure_infos.reserve(structures.size());
    for (const auto& [binding, structure] : structures) {
        structure_infos.emplace_back(1, &structure);
        vk::WriteDescriptorSet write(set_, binding, 0, 1, vk::DescriptorType::eAccelerationStructureKHR);
        write.pNext = &structure_infos.back();
        writes.push_back(write);
    }
    device.handle().updateDescriptorSets(writes, {});
}

} // namespace prt
