#pragma once

#include "prt/scene.h"
#include "prt/transfer.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Where transfer is wanted. The baker does not care where receivers come from: vertices, samples on a
/// surface, texels, probes. Arrays are parallel.
struct Receivers {
    std::vector<glm::vec3> positions; ///< metres
    std::vector<glm::vec3> normals;   ///< unit; zero: no surface here, the transfer is zero
    std::vector<float> areas;         ///< m²; zero: nobody sees it, the transfer is zero
    /// Where the surface lies that a receiver stands for, seen from its position: unit, zero for all sides
    /// alike. A vertex on the edge of a floor lies in the plane of the wall that rises there, and without
    /// this no rounding tells on which side of it. Empty: zero for all.
    std::vector<glm::vec3> inward = {};

    std::size_t size() const { return positions.size(); }
};

/// Every vertex of the scene, in the order of its vertex arrays, with a third of the area of its triangles.
Receivers vertex_receivers(const Scene& scene);

/// Direct transfer of every vertex as if nothing shadowed it: the lobes of their normals.
Transfer unshadowed_transfer(const Scene& scene, int order);

} // namespace prt
