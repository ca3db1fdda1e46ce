#pragma once

// Lookup of lightmaps at surface points, with the filtering of a renderer. Experimental.

#include "prt/lightmap.h"
#include "prt/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Finds the texels of points on the triangles of a scene. Thread-safe.
class LightmapLookup {
public:
    /// Keeps references to `scene` and `layout`.
    LightmapLookup(const Scene& scene, const LightmapLayout& layout);

    /// Returns the texels, numbered as in the layout, and the weights of the bilinear sample at a point.
    /// `triangle`: index in the order of the scene's primitives and their triangles. `barycentrics`:
    /// barycentric coordinates of corners 1 and 2.
    BilinearTexels filter(std::uint32_t triangle, const glm::vec2& barycentrics) const;
    /// Returns the bilinear sample of `values` [texels of the layout] at the point of `filter`.
    glm::vec3 look_up(std::uint32_t triangle, const glm::vec2& barycentrics,
                      std::span<const glm::vec3> values) const;

private:
    const Scene& scene_;
    const LightmapLayout& layout_;
    std::vector<std::size_t> first_texels_;
    std::vector<std::uint32_t> first_triangles_; ///< [primitives + 1]
};

/// Samples `values` [texels of the layout] at the vertices of `scene`, [receivers].
std::vector<glm::vec3> at_vertices(const Scene& scene, const LightmapLayout& layout,
                                   std::span<const glm::vec3> values);

} // namespace prt
