// Reports a driver's statistics of the baker's kernels: registers, occupancy and cycles, by
// VK_KHR_pipeline_executable_properties. Runs no kernel, so that AMD's driver works for hardware that is not
// present. Prints JSON: {kernel: {statistic: number}}. See tests/benchmarks/gpu_static.py.

#include "shared_bake.h"

#include <cstdint>
#include <vulkan/vulkan_raii.hpp>

#include "kernels/bake_accumulate.h"
#include "kernels/bake_blocked.h"
#include "kernels/bake_blocked_query.h"
#include "kernels/bake_lamps.h"
#include "kernels/bake_lamps_query.h"
#include "kernels/bake_trace.h"
#include "kernels/bake_trace_query.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

using Words = std::span<const std::uint32_t>;
using Constants = std::map<std::uint32_t, std::uint32_t>;

constexpr std::uint32_t kMaxBinding = PRT_BINDING_SIGNED_SUMS;

struct Device {
    vk::raii::Context context;
    vk::raii::Instance instance = nullptr;
    vk::raii::PhysicalDevice physical = nullptr;
    vk::raii::Device device = nullptr;
};

Device open_device() {
    Device d;
    const vk::ApplicationInfo application("kernel_cost", 1, nullptr, 0, VK_API_VERSION_1_2);
    d.instance = vk::raii::Instance(d.context, {{}, &application});
    d.physical = std::move(vk::raii::PhysicalDevices(d.instance).front());
    const char* const extensions[] = {
        VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
        VK_KHR_RAY_QUERY_EXTENSION_NAME, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue({}, 0, 1, &priority);
    vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceVulkan12Features,
                       vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                       vk::PhysicalDeviceRayQueryFeaturesKHR,
                       vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>
        info;
    info.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue).setPEnabledExtensionNames(extensions);
    info.get<vk::PhysicalDeviceVulkan12Features>().bufferDeviceAddress = true;
    info.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure = true;
    info.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery = true;
    info.get<vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR>().pipelineExecutableInfo = true;
    d.device = vk::raii::Device(d.physical, info.get<vk::DeviceCreateInfo>());
    return d;
}

nlohmann::ordered_json cost(const Device& d, Words spirv, bool queries, const Constants& constants) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (std::uint32_t b = 1; b <= kMaxBinding; ++b)
        bindings.emplace_back(b,
                              queries && b == PRT_BINDING_NODES
                                  ? vk::DescriptorType::eAccelerationStructureKHR
                                  : vk::DescriptorType::eStorageBuffer,
                              1, vk::ShaderStageFlagBits::eCompute);
    const vk::raii::DescriptorSetLayout set(d.device, {{}, bindings});
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, 128);
    const vk::raii::PipelineLayout layout(d.device, {{}, *set, push});
    const vk::raii::ShaderModule shader(d.device, {{}, spirv.size_bytes(), spirv.data()});
    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const auto& [id, value] : constants) {
        entries.emplace_back(id, static_cast<std::uint32_t>(4 * values.size()), 4);
        values.push_back(value);
    }
    const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                                4 * values.size(), values.data());
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main",
                                                  &specialization);
    const vk::raii::Pipeline pipeline = d.device.createComputePipeline(
        nullptr,
        vk::ComputePipelineCreateInfo(vk::PipelineCreateFlagBits::eCaptureStatisticsKHR, stage, *layout));
    nlohmann::ordered_json result;
    for (const auto& s : d.device.getPipelineExecutableStatisticsKHR({*pipeline, 0}))
        result[s.name.data()] = s.value.u64;
    return result;
}

} // namespace

int main() {
    try {
        const Device d = open_device();
        nlohmann::ordered_json all;
        const auto add = [&](const std::string& name, Words compute, Words query,
                             const Constants& constants) {
            all[name + ", our hierarchy"] = cost(d, compute, false, constants);
            all[name + ", ray queries"] = cost(d, query, true, constants);
        };
        const auto traced = [](std::uint32_t alpha, std::uint32_t hits) -> Constants {
            return {{PRT_CONSTANT_ALPHA, alpha},
                    {PRT_CONSTANT_TEXTURED, alpha},
                    {PRT_CONSTANT_HITS, hits},
                    {PRT_CONSTANT_STACK, 64}};
        };
        add("trace", bake_trace, bake_trace_query, traced(0, 0));
        add("trace with hits", bake_trace, bake_trace_query, traced(0, 1));
        add("trace through alpha", bake_trace, bake_trace_query, traced(1, 0));
        add("trace through alpha with hits", bake_trace, bake_trace_query, traced(1, 1));
        add("count blocked", bake_blocked, bake_blocked_query, traced(0, 1));
        add("lamps", bake_lamps, bake_lamps_query, traced(0, 0));
        for (const std::uint32_t order : {3u, 6u, 10u})
            for (const std::uint32_t summed : {0u, 1u})
                all[(summed ? "accumulate to sums, order " : "accumulate, order ") + std::to_string(order)] =
                    cost(d, bake_accumulate, false,
                         {{PRT_CONSTANT_ORDER, order},
                          {PRT_CONSTANT_SUBGROUPS, 1},
                          {PRT_CONSTANT_SUMMED, summed}});
        std::puts(all.dump(1).c_str());
        std::fflush(stdout);
        _exit(0); // absent hardware cannot be shut down cleanly
    } catch (const std::exception& error) {
        std::fprintf(stderr, "kernel_cost: %s\n", error.what());
        return 1;
    }
}
