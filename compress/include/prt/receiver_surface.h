#pragma once

// What is known of receivers beside their transfer: how much an error counts, who is beside whom, and what a
// renderer has of each.

#include "prt/lightmap.h"
#include "prt/mesh_edges.h"
#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Keeps references.
struct ReceiverSurface {
    std::span<const float> areas;     ///< [receivers]: how much an error counts; where 0 it does not
    std::span<const Edge> edges = {}; ///< needed where seams have a price
    /// [receivers], or nothing where the renderer has none: unit, or zero; metres, seen from Scene::origin.
    std::span<const glm::vec3> normals = {}, positions = {};
    std::span<const SeamJump> jumps = {}; ///< of lightmaps, to be closed
};

/// The surface of a scene whose receivers are its vertices.
struct SceneSurface {
    std::vector<float> areas;
    std::vector<Edge> edges;
    std::vector<glm::vec3> normals, positions;
    std::vector<SeamJump> jumps;

    SceneSurface() = default;
    explicit SceneSurface(const Scene& scene);
    ReceiverSurface view() const { return {areas, edges, normals, positions, jumps}; }
};

} // namespace prt
