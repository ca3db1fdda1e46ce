#pragma once

// The lamps of a scene in the buffers that shaders/bake_lamps.comp reads.

#include "lamps/choose_lamps.h"
#include "prt/gl_objects.h"
#include "prt/trace_scene.h"
#include "trace/gpu/gpu_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

class GpuLamps {
public:
    /// What a lamp has of the buffers.
    struct Ranges {
        std::uint32_t first_light, end_light, first_triangle, end_triangle;
        std::uint32_t lights() const { return end_light - first_light; }
        std::uint32_t triangles() const { return end_triangle - first_triangle; }
    };

    /// Uploads. A context must be current. Throws `Error` when memory runs out.
    GpuLamps(const GpuScene& gpu_scene, const TraceScene& scene, std::span<const Lamp> lamps);

    const Ranges& ranges(std::size_t lamp) const { return ranges_[lamp]; }
    void bind() const;

private:
    std::vector<Ranges> ranges_;
    GlObject lights_, triangles_, images_, texels_;
};

} // namespace prt
