#pragma once

// Receiver data in addition to transfer: the weight of errors, neighbours, and the attributes that a renderer
// has.

#include "prt/lightmap.h"
#include "prt/mesh_edges.h"
#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// View of the data of receivers. Keeps references.
struct ReceiverSurface {
    std::span<const float> areas;     ///< [receivers] weight of an error; 0: ignored
    std::span<const Edge> edges = {}; ///< required if seams have a multiplier
    /// [receivers], or empty if the renderer does not have them: unit or zero; metres, relative to
    /// Scene::origin.
    std::span<const glm::vec3> normals = {}, positions = {};
    std::span<const SeamJump> jumps = {}; ///< jumps at UV seams of lightmaps that are minimised
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
