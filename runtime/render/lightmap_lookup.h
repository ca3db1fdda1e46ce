#pragma once

// Looks up lightmaps at surface points on the CPU, with the bilinear filter of a GPU. Experimental.

#include "prt/core/lightmap.h"
#include "prt/load/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Finds the lightmap texels of points on the triangles of a scene. Immutable, thread-safe.
class LightmapLookup {
public:
    /// Keeps references to `scene` and `layout`, which must belong together and outlive this object.
    LightmapLookup(const Scene& scene, const LightmapLayout& layout);

    /// Returns whether a triangle shows texels; others have lobes. `triangle`: as for `filter`.
    bool has_texels(std::uint32_t triangle) const;
    /// Returns the four texels and weights of the bilinear sample at a point of a triangle. Texels are
    /// numbered over all maps of the layout: indices into an array [layout.texels()]. `triangle`: number of
    /// the triangle, counted over all primitives of the scene in order. `barycentrics`: barycentric
    /// coordinates of the second and the third corner of the triangle, which must show texels.
    BilinearTexels filter(std::uint32_t triangle, const glm::vec2& barycentrics) const;
    /// Returns the bilinear sample of `values` at a point of a triangle. `values`: [layout.texels()].
    /// `triangle`: number of the triangle, counted over all primitives of the scene in order. `barycentrics`:
    /// barycentric coordinates of the second and the third corner.
    glm::vec3 look_up(std::uint32_t triangle, const glm::vec2& barycentrics,
                      std::span<const glm::vec3> values) const;

private:
    std::size_t primitive_of(std::uint32_t triangle) const;

    const Scene& scene_;
    const LightmapLayout& layout_;
    std::vector<std::size_t> first_texels_;
    std::vector<std::uint32_t> first_triangles_; ///< [primitives + 1]
};

/// Returns the bilinear samples of `values` [layout.texels()] at the vertices of `scene`:
/// [receivers of the scene]. If several primitives share vertices, the last one determines the map and the UV
/// set. Vertices without texels get 0.
std::vector<glm::vec3> at_vertices(const Scene& scene, const LightmapLayout& layout,
                                   std::span<const glm::vec3> values);

} // namespace prt
