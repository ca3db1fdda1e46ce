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
    /// Builds a hierarchy, by the device where it traverses itself, and uploads. Throws `Error` where the
    /// scene does not fit.
    GpuScene(const VulkanDevice& device, GpuQueue& queue, const TraceScene& scene);

    bool has_alpha() const { return has_alpha_; }
    const AlphaTables& alpha() const { return alpha_; }
    std::size_t bytes() const; ///< in the device's memory
    /// What a kernel that traces has of it, beside what is its own.
    GpuResources resources() const;
    /// Its specialisation constants, where `textured` asks for footprints.
    std::map<std::uint32_t, std::uint32_t> constants() const;

private:
    bool has_alpha_, textured_;
    AlphaTables alpha_;
    std::uint32_t opaque_ = 0;
    int levels_ = 0;
    GpuBuffer nodes_, corners_, alpha_triangles_, alpha_materials_, alpha_texels_;
    std::optional<AccelerationStructure> structure_;
};

} // namespace prt
