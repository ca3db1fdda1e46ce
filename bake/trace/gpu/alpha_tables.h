#pragma once

// The triangles of a scene as the bake shaders read them, and tables of those that do not stop all light.

#include "prt/trace_scene.h"
#include "trace/gpu/gpu_structs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct AlphaTables {
    std::vector<std::uint32_t> index;          ///< [triangles], counting from 1; 0: opaque
    std::vector<gpu::AlphaTriangle> triangles; ///< [triangles that are not opaque][layers]
    std::vector<gpu::AlphaMaterial> materials; ///< [primitives][layers]
    std::vector<std::uint8_t> texels;
};

/// Of `triangles`; those of the others are 0.
AlphaTables make_alpha_tables(const TraceScene& scene, std::span<const std::uint32_t> triangles);

/// Those that cast shadows: the opaque ones, then the others.
std::vector<std::uint32_t> shadowing_triangles(const TraceScene& scene);

/// Corners of `triangles`, [triangles][3]; w: the triangle, its place in the alpha table, as bits.
std::vector<glm::vec4> tagged_corners(const TraceScene& scene, std::span<const std::uint32_t> triangles,
                                      const AlphaTables& alpha);

} // namespace prt
