#pragma once

// A scene on a Vulkan device, in the layout of the tracing kernels.

#include "bake/device/acceleration_structure.h"
#include "bake/device/gpu_kernel.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace_gpu/alpha_tables.h"

#include <map>
#include <optional>

namespace prt {

class GpuScene {
public:
    /// Builds a hierarchy and uploads it. Devices with ray queries build it themselves; it then contains
    /// instanced meshes once. Throws `Error` if the scene does not fit into memory.
    GpuScene(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);

    bool has_alpha() const { return has_alpha_; }
    const AlphaTables& alpha() const { return alpha_; }
    std::size_t bytes() const; ///< bytes in the device's memory
    /// Number of instances of meshes that are stored once, including the first instances.
    std::size_t copies() const { return copies_; }
    /// Resources for a tracing kernel, in addition to the kernel's own.
    GpuResources resources() const;
    /// Specialisation constants of the scene.
    std::map<std::uint32_t, std::uint32_t> constants() const;

private:
    void build_structure(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);
    void build_nodes(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);
    void upload_tables(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene,
                       std::span<const std::uint32_t> slots);

    bool has_alpha_, textured_;
    AlphaTables alpha_;
    std::uint32_t opaque_ = 0; ///< number of opaque triangles in the mesh of triangles without instances;
                               ///< they come first
    int levels_ = 0;
    std::size_t copies_ = 0;
    struct Tables {
        GpuBuffer nodes, instances, corners, alpha_triangles, alpha_materials, alpha_texels;
    };
    Tables tables_;
    std::optional<AccelerationStructure> structure_;
};

} // namespace prt
