#pragma once

// A scene on a Vulkan device, as the kernels that trace read it.

#include "prt/trace_scene.h"
#include "trace/gpu/alpha_tables.h"
#include "vulkan/acceleration_structure.h"
#include "vulkan/gpu_kernel.h"

#include <map>
#include <optional>

namespace prt {

class GpuScene {
public:
    /// Builds a hierarchy, by the device where it traverses itself, and uploads. Meshes that stand in the
    /// scene several times are there once for the device's own. Throws `Error` where the scene does not fit.
    GpuScene(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);

    bool has_alpha() const { return has_alpha_; }
    const AlphaTables& alpha() const { return alpha_; }
    std::size_t bytes() const;                     ///< in the device's memory
    std::size_t copies() const { return copies_; } ///< of meshes that it has once, the first ones too
    /// What a kernel that traces has of it, beside what is its own.
    GpuResources resources() const;
    /// Its specialisation constants.
    std::map<std::uint32_t, std::uint32_t> constants() const;

private:
    void build_structure(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);
    void build_nodes(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);
    void upload_tables(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene,
                       std::span<const std::uint32_t> slots);

    bool has_alpha_, textured_;
    AlphaTables alpha_;
    std::uint32_t opaque_ = 0; ///< triangles before the others, of those that stand alone
    int levels_ = 0;
    std::size_t copies_ = 0;
    struct Tables {
        GpuBuffer nodes, instances, corners, alpha_triangles, alpha_materials, alpha_texels;
    };
    Tables tables_;
    std::optional<AccelerationStructure> structure_;
};

} // namespace prt
