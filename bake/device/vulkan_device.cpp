// Lists Vulkan devices, chooses one and opens it.

#include "bake/device/vulkan_device.h"

#include "bake/device/gpu_devices.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>

namespace prt {
namespace {

constexpr std::uint32_t kVersion = VK_API_VERSION_1_2;
constexpr std::uint32_t kMaxBuffers = 13; ///< storage buffers of a kernel
constexpr const char* kValidation = "VK_LAYER_KHRONOS_validation";
constexpr const char* kQueryExtensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                            VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                            VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

bool has_extension(const vk::raii::PhysicalDevice& device, const char* name) {
    return std::ranges::any_of(device.enumerateDeviceExtensionProperties(), [&](const auto& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

bool has_ray_queries(const vk::raii::PhysicalDevice& device) {
    if (!std::ranges::all_of(kQueryExtensions, [&](const char* name) { return has_extension(device, name); }))
        return false;
    const auto features = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                              vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                                              vk::PhysicalDeviceRayQueryFeaturesKHR>();
    return features.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery &&
           features.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure &&
           features.get<vk::PhysicalDeviceVulkan12Features>().bufferDeviceAddress;
}

std::optional<std::uint32_t> compute_family(const vk::raii::PhysicalDevice& device) {
    const auto families = device.getQueueFamilyProperties();
    // A queue family with graphics is the device's widest; a family without graphics runs in parallel to the
    // desktop.
    for (const bool alone : {true, false})
        for (std::uint32_t f = 0; f < families.size(); ++f) {
            const vk::QueueFlags flags = families[f].queueFlags;
            if ((flags & vk::QueueFlagBits::eCompute) &&
                alone != static_cast<bool>(flags & vk::QueueFlagBits::eGraphics))
                return f;
        }
    return std::nullopt;
}

/// Returns a feature that a bake needs and the device lacks; empty: none.
std::string missing(const vk::raii::PhysicalDevice& device) {
    if (device.getProperties().apiVersion < kVersion)
        return "Vulkan 1.2";
    if (!compute_family(device))
        return "compute queue";
    if (device.getProperties().limits.maxPerStageDescriptorStorageBuffers < kMaxBuffers)
        return fmt::format("support for {} storage buffers per shader", kMaxBuffers);
    const auto features =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    if (!features.get<vk::PhysicalDeviceVulkan12Features>().timelineSemaphore)
        return "timeline semaphores";
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    const auto& subgroups = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    constexpr vk::SubgroupFeatureFlags kNeeded =
        vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eArithmetic;
    if (!(subgroups.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute) ||
        (subgroups.subgroupSupportedOperations & kNeeded) != kNeeded)
        return "subgroup arithmetic in compute shaders";
    return "";
}

GpuDevice describe(const vk::raii::PhysicalDevice& device) {
    GpuDevice about;
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const vk::PhysicalDeviceProperties& common = properties.get<vk::PhysicalDeviceProperties2>().properties;
    about.name = common.deviceName.data();
    about.hardware = common.deviceType != vk::PhysicalDeviceType::eCpu;
    about.missing_feature = missing(device);
    if (common.apiVersion >= kVersion) {
        const auto& driver = properties.get<vk::PhysicalDeviceDriverProperties>();
        about.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
        about.ray_queries = about.missing_feature.empty() && has_ray_queries(device);
    }
    const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
    for (std::uint32_t h = 0; h < memory.memoryHeapCount; ++h)
        if (memory.memoryHeaps[h].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            about.memory = std::max(about.memory, static_cast<double>(memory.memoryHeaps[h].size));
    return about;
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::optional<std::size_t> as_number(const std::string& text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::string listed(std::span<const GpuDevice> devices) {
    std::string names;
    for (std::size_t i = 0; i < devices.size(); ++i)
        names += fmt::format("{}{} is \"{}\"", i == 0 ? "" : ", ", i, devices[i].name);
    return names;
}

/// Returns the best of the suitable devices: hardware before software, and then the largest memory.
std::size_t best_device(std::span<const GpuDevice> devices, bool hardware_only) {
    std::optional<std::size_t> best;
    std::string why;
    const auto rank = [&](std::size_t i) { return std::pair(devices[i].hardware, devices[i].memory); };
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (!devices[i].missing_feature.empty())
            why += fmt::format("{}\"{}\" has no {}", why.empty() ? "" : ", ", devices[i].name,
                               devices[i].missing_feature);
        else if (hardware_only && !devices[i].hardware)
            why += fmt::format("{}\"{}\" is a software device", why.empty() ? "" : ", ", devices[i].name);
        else if (!best || rank(i) > rank(*best))
            best = i;
    }
    if (!best)
        throw Error(fmt::format("no GPU can be used for baking ({})",
                                why.empty() ? "no driver for Vulkan is installed" : why));
    return *best;
}

VKAPI_ATTR VkBool32 VKAPI_CALL note_complaint(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                              VkDebugUtilsMessageTypeFlagsEXT,
                                              const VkDebugUtilsMessengerCallbackDataEXT* data,
                                              void* complaints) {
    static_cast<std::vector<std::string>*>(complaints)->push_back(one_line(data->pMessage));
    return VK_FALSE;
}

vk::raii::Context open_loader() {
    try {
        return {};
    } catch (const std::exception&) {
        throw Error("Vulkan is not available: its loader, libvulkan, is not installed");
    }
}

vk::raii::Instance open_instance(const vk::raii::Context& context, bool validate) {
    const vk::ApplicationInfo application("prtkit", 1, nullptr, 0, kVersion);
    vk::InstanceCreateInfo info({}, &application);
    const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validate) {
        info.setPEnabledLayerNames(kValidation);
        info.setPEnabledExtensionNames(extension);
    }
    try {
        return {context, info};
    } catch (const vk::IncompatibleDriverError&) {
        throw Error("no GPU can be used for baking (no driver for Vulkan is installed)");
    } catch (const vk::LayerNotPresentError&) {
        throw Error("Vulkan's validation layer is not installed");
    }
}

} // namespace

std::size_t named_device(std::span<const GpuDevice> devices, const std::string& which) {
    if (const std::optional<std::size_t> number = as_number(which); number && *number < devices.size())
        return *number;
    std::vector<std::size_t> fitting;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (lower(devices[i].name).find(lower(which)) != std::string::npos)
            fitting.push_back(i);
    if (fitting.size() == 1)
        return fitting.front();
    throw Error(fmt::format("{} GPU has \"{}\" as its number or in its name; available: {}",
                            fitting.empty() ? "no" : "more than one", which, listed(devices)));
}

std::vector<GpuDevice> gpu_devices() {
    std::vector<GpuDevice> devices;
    try {
        const vk::raii::Context context = open_loader();
        const vk::raii::Instance instance = open_instance(context, false);
        for (const vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance))
            devices.push_back(describe(device));
    } catch (const Error&) {
        return {}; // no Vulkan: no devices
    } catch (const vk::SystemError&) {
        return {};
    }
    return devices;
}

bool may_have_hardware() {
#ifdef __linux__
    // Device files of DRM (AMD, Intel, and others), NVIDIA, Windows in WSL, Qualcomm, Arm, Imagination.
    std::error_code missing;
    return std::ranges::any_of(
        std::to_array<const char*>({"/dev/dri", "/dev/nvidiactl", "/dev/nvidia0", "/dev/dxg", "/dev/kgsl-3d0",
                                    "/dev/mali0", "/dev/pvrsrvkm"}),
        [&](const char* file) { return std::filesystem::exists(file, missing); });
#else
    return true;
#endif
}

VulkanDevice::VulkanDevice(const VulkanChoice& choice)
    : context_(open_loader()), complaints_(std::make_unique<std::vector<std::string>>()) {
    with_vulkan_errors([&] {
        make_instance(choice.validate);
        std::vector<vk::raii::PhysicalDevice> found;
        std::vector<GpuDevice> devices;
        try {
            for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance_)) {
                devices.push_back(describe(device));
                found.push_back(std::move(device));
            }
        } catch (const vk::InitializationFailedError&) {
            devices.clear(); // reported by some loaders if no driver starts
        }
        const std::size_t chosen = choice.device.empty() ? best_device(devices, choice.hardware_only)
                                                         : named_device(devices, choice.device);
        traits_.about = devices[chosen];
        if (!traits_.about.missing_feature.empty())
            throw Error(fmt::format("\"{}\" cannot be used for baking: it has no {}", traits_.about.name,
                                    traits_.about.missing_feature));
        if (choice.traversal == Traversal::device && !traits_.about.ray_queries)
            throw Error(fmt::format("\"{}\" has no ray queries; use --device gpu,traversal=compute",
                                    traits_.about.name));
        traits_.ray_queries = choice.traversal != Traversal::compute && traits_.about.ray_queries;
        physical_ = std::move(found[chosen]);
        make_device();
    });
}

void VulkanDevice::make_instance(bool validate) {
    instance_ = open_instance(context_, validate);
    if (!validate)
        return;
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    messenger_ = instance_.createDebugUtilsMessengerEXT({{},
                                                         Severity::eWarning | Severity::eError,
                                                         Type::eGeneral | Type::eValidation,
                                                         note_complaint,
                                                         complaints_.get()});
}

void VulkanDevice::make_device() {
    family_ = *compute_family(physical_);
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue({}, family_, 1, &priority);
    vk::StructureChain<vk::DeviceCreateInfo, vk::PhysicalDeviceVulkan12Features,
                       vk::PhysicalDeviceAccelerationStructureFeaturesKHR,
                       vk::PhysicalDeviceRayQueryFeaturesKHR>
        info;
    info.get<vk::DeviceCreateInfo>().setQueueCreateInfos(queue);
    auto& common = info.get<vk::PhysicalDeviceVulkan12Features>();
    common.timelineSemaphore = true;
    if (traits_.ray_queries) {
        info.get<vk::DeviceCreateInfo>().setPEnabledExtensionNames(kQueryExtensions);
        common.bufferDeviceAddress = true;
        info.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure = true;
        info.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery = true;
    } else {
        info.unlink<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>();
        info.unlink<vk::PhysicalDeviceRayQueryFeaturesKHR>();
    }
    device_ = vk::raii::Device(physical_, info.get<vk::DeviceCreateInfo>());
    queue_ = vk::raii::Queue(device_, family_, 0);

    const auto properties =
        physical_.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                 vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    const vk::PhysicalDeviceLimits& limits =
        properties.get<vk::PhysicalDeviceProperties2>().properties.limits;
    const auto& eleven = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    const auto& structures = properties.get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    traits_.max_bytes = std::min<std::size_t>(limits.maxStorageBufferRange,
                                              static_cast<std::size_t>(eleven.maxMemoryAllocationSize));
    traits_.min_subgroup = eleven.subgroupSize;
    if (has_extension(physical_,
                      VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME)) // some compilers choose the size per
                                                                    // kernel
        traits_.min_subgroup = std::min(traits_.min_subgroup,
                                        physical_
                                            .getProperties2<vk::PhysicalDeviceProperties2,
                                                            vk::PhysicalDeviceSubgroupSizeControlProperties>()
                                            .get<vk::PhysicalDeviceSubgroupSizeControlProperties>()
                                            .minSubgroupSize);
    traits_.max_groups = limits.maxComputeWorkGroupCount[0];
    traits_.clock_bits = physical_.getQueueFamilyProperties()[family_].timestampValidBits;
    if (traits_.clock_bits > 0)
        traits_.clock_seconds = 1e-9 * static_cast<double>(limits.timestampPeriod);
    if (traits_.ray_queries) {
        traits_.scratch_alignment = structures.minAccelerationStructureScratchOffsetAlignment;
        traits_.max_instances = structures.maxInstanceCount;
        traits_.max_triangles = structures.maxPrimitiveCount;
    }
}

std::uint32_t VulkanDevice::memory_kind(std::uint32_t kinds, vk::MemoryPropertyFlags wanted) const {
    const vk::PhysicalDeviceMemoryProperties memory = physical_.getMemoryProperties();
    for (std::uint32_t kind = 0; kind < memory.memoryTypeCount; ++kind)
        if ((kinds >> kind & 1) != 0 && (memory.memoryTypes[kind].propertyFlags & wanted) == wanted)
            return kind;
    throw Error(
        fmt::format("\"{}\" has no memory of the type {}", traits_.about.name, vk::to_string(wanted)));
}

} // namespace prt
