#pragma once

#include "prt/scene.h"
#include "prt/transfer.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// Points where transfer is computed: vertices, samples of a surface, texels or probes. The baker does not
/// distinguish them. Arrays are parallel.
struct Receivers {
    std::vector<glm::vec3> positions; ///< metres
    std::vector<glm::vec3> normals;   ///< unit; zero: no surface here, the transfer is zero
    std::vector<float> areas;         ///< m²; zero: the triangles have no area, the transfer is zero
    /// Ray origins relative to the position, in units of RayScene::surface_offset; empty: the normals. A
    /// vertex needs more than its normal, which may point below its faces.
    std::vector<glm::vec3> starts = {};

    std::size_t size() const { return positions.size(); }
    /// Appends receiver `index` of `from`. Both must have starts, or both none.
    void append(const Receivers& from, std::size_t index);
};

/// Returns every vertex of the scene, in the order of its vertex arrays. The area of a vertex is a third of
/// the area of its triangles.
Receivers vertex_receivers(const Scene& scene);

/// Returns the indices of receivers that have an area and a normal.
std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers);

/// Returns the direct transfer of every vertex without shadows: the cosine lobes of their normals.
Transfer unshadowed_transfer(const Scene& scene, int order);

} // namespace prt
