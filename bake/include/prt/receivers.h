#pragma once

#include "prt/scene.h"
#include "prt/transfer.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// Where transfer is wanted. The baker does not care where receivers come from: vertices, samples on a
/// surface, texels, probes. Arrays are parallel.
struct Receivers {
    std::vector<glm::vec3> positions; ///< metres
    std::vector<glm::vec3> normals;   ///< unit; zero: no surface here, the transfer is zero
    std::vector<float> areas;         ///< m²; zero: of triangles without area, the transfer is zero
    /// Where rays start, seen from the position, in units of RayScene::surface_offset; empty: the normals. A
    /// vertex needs more than its normal, which may lean below its faces.
    std::vector<glm::vec3> starts = {};

    std::size_t size() const { return positions.size(); }
    /// Appends receiver `index` of `from`, whose starts are as empty as here.
    void append(const Receivers& from, std::size_t index);
};

/// Every vertex of the scene, in the order of its vertex arrays, with a third of the area of its triangles.
Receivers vertex_receivers(const Scene& scene);

/// Those with an area and a normal.
std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers);

/// Direct transfer of every vertex as if nothing shadowed it: the lobes of their normals.
Transfer unshadowed_transfer(const Scene& scene, int order);

} // namespace prt
