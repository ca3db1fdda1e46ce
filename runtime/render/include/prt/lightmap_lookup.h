#pragma once

// Lightmaps looked up at places of surfaces, as a renderer filters them. Experimental.

#include "prt/lightmap.h"
#include "prt/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Where the triangles of a scene lie in its maps. Thread-safe.
class LightmapLookup {
public:
    /// Keeps references to both.
    LightmapLookup(const Scene& scene, const LightmapLayout& layout);

    /// What a bilinear filter reads at a place of `triangle`, in the order of the scene's primitives and
    /// their triangles; `barycentrics` of corners 1 and 2. Texels are numbered as those of the layout.
    BilinearTexels filter(std::uint32_t triangle, const glm::vec2& barycentrics) const;
    /// The mean that it gives of `values` [texels of the layout].
    glm::vec3 look_up(std::uint32_t triangle, const glm::vec2& barycentrics,
                      std::span<const glm::vec3> values) const;

private:
    const Scene& scene_;
    const LightmapLayout& layout_;
    std::vector<std::size_t> first_texels_;
    std::vector<std::uint32_t> first_triangles_; ///< [primitives + 1]
};

/// `values` [texels of the layout] at the vertices of `scene`, [receivers].
std::vector<glm::vec3> at_vertices(const Scene& scene, const LightmapLayout& layout,
                                   std::span<const glm::vec3> values);

} // namespace prt
