#pragma once

// The lamps of a scene in the layout of shaders/bake_lamps.comp.

#include "bake/scene/trace_scene.h"
#include "bake/trace/choose_lamps.h"
#include "bake/trace_gpu/alpha_tables.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct LampTables {
    /// Ranges of one lamp in the tables.
    struct Ranges {
        std::uint32_t first_light, end_light, first_triangle, end_triangle;
        std::uint32_t lights() const { return end_light - first_light; }
        std::uint32_t triangles() const { return end_triangle - first_triangle; }
    };
    std::vector<Ranges> ranges; ///< [lamps]
    std::vector<gpu::PunctualLight> lights;
    std::vector<gpu::ShiningTriangle> triangles;
    std::vector<gpu::EmissionImage> images;
    std::vector<std::uint32_t> texels;
};

LampTables make_lamp_tables(const TraceScene& scene, std::span<const Lamp> lamps, const AlphaTables& alpha);

} // namespace prt
