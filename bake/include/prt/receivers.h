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
    std::vector<float> areas;         ///< m²; 1 for probes; zero: the transfer is zero
    /// Ray origins relative to the positions, in units of RayScene::surface_offset; empty: the normals. They
    /// are needed for vertices, whose normals may point below their faces.
    std::vector<glm::vec3> starts = {};

    std::size_t size() const { return positions.size(); }
    /// Appends receiver `index` of `from`. `starts` must be empty in both or in neither.
    void append(const Receivers& from, std::size_t index);
};

/// Returns all vertices of the scene as receivers, in the order of its vertex arrays. The area of a vertex is
/// a third of the area of its triangles.
Receivers vertex_receivers(const Scene& scene);

/// Returns the indices of receivers that have an area and a normal.
std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers);

/// Returns the direct transfer of all vertices without shadows: the cosine lobe of each normal.
Transfer unshadowed_transfer(const Scene& scene, int order);

} // namespace prt
