#pragma once

// Data of receivers in addition to transfer: areas, neighbours, and attributes that a renderer has.

#include "prt/lightmap.h"
#include "prt/mesh_edges.h"
#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Non-owning view of the data of receivers.
struct ReceiverSurface {
    std::span<const float> areas; ///< [receivers] weight of an error; 0: ignored
    /// Edges between receivers; required if CompressOptions::seam_weight is not 0.
    std::span<const Edge> edges = {};
    /// [receivers], or empty if the renderer does not have them. `normals`: unit or zero. `positions`:
    /// metres, relative to Scene::origin.
    std::span<const glm::vec3> normals = {}, positions = {};
    std::span<const SeamJump> jumps = {}; ///< points on UV seams of lightmaps, whose jumps are minimised
};

/// Data of the vertices of a scene as receivers.
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
