#pragma once

// Triangles of a scene in the layout of the bake shaders, and tables of triangles that do not stop all light.

#include "bake/scene/trace_scene.h"
#include "shared_structs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct AlphaTables {
    std::vector<std::uint32_t> index;          ///< [triangles] index into `triangles`, counting from 1; 0:
                                               ///< opaque
    std::vector<gpu::AlphaTriangle> triangles; ///< [triangles that are not opaque][layers]
    std::vector<gpu::AlphaMaterial> materials; ///< [primitives][layers]
    std::vector<std::uint8_t> texels;
};

/// Builds the tables of `triangles`; the index of all other triangles is 0.
AlphaTables make_alpha_tables(const TraceScene& scene, std::span<const std::uint32_t> triangles);

/// Returns the triangles that rays can hit, opaque ones first.
std::vector<std::uint32_t> shadowing_triangles(const TraceScene& scene);

/// Returns the corners of `triangles`, [triangles][3]; the w components hold the index of the triangle and
/// its index in the alpha table, as bits.
std::vector<glm::vec4> tagged_corners(const TraceScene& scene, std::span<const std::uint32_t> triangles,
                                      const AlphaTables& alpha);

} // namespace prt
