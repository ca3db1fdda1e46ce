#pragma once

// Data of receivers that the compressor needs in addition to transfer: areas, edges, and attributes that a
// renderer has.

#include "prt/core/adjacency.h"
#include "prt/core/lightmap.h"
#include "prt/load/scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Data of receivers. Does not own the arrays, which must outlive it.
struct ReceiverSurface {
    /// [receivers] m², or any other weight of a receiver in errors; 0: errors at this receiver have no cost.
    std::span<const float> areas;
    /// Edges between neighbouring receivers, along which the compressor reduces jumps of the error
    /// (CompressOptions::seam_weight). Empty: it reduces no jumps.
    std::span<const Edge> edges = {};
    /// Attributes for predictors: `normals` (unit or zero) and `positions` (metres, relative to
    /// Scene::origin). Each is [receivers], or empty if the renderer does not have the attribute; the
    /// compressor then does not use the predictor of this attribute.
    std::span<const glm::vec3> normals = {}, positions = {};
    /// Points on UV seams of lightmaps, whose jumps the compressor also reduces. Ignored if `edges` is empty.
    std::span<const SeamJump> jumps = {};
};

/// Receiver attributes that act as predictors (prt/core/clustered_bases.h). The renderer must have these
/// vertex attributes. Each predictor costs three multiply-adds of a color in the vertex shader, and three
/// rows per cluster. A predictor is not used if its attribute is missing in `ReceiverSurface`, or is equal at
/// all receivers.
enum class PredictorChoice {
    none,               ///< no predictors
    normal,             ///< the normal
    normal_and_position ///< the normal and the position: six multiply-adds and six rows
};

/// Owns the arrays of a `ReceiverSurface` for the vertices of a scene as receivers.
struct SceneSurface {
    std::vector<float> areas; ///< [receivers] m²: a third of the area of the triangles at each vertex
    std::vector<Edge> edges;  ///< edges of all triangles, without duplicates
    /// [receivers] each: unit normals (zero if undefined), and positions in metres relative to Scene::origin.
    std::vector<glm::vec3> normals, positions;
    std::vector<SeamJump> jumps; ///< empty, because vertices have no UV seams

    /// Creates empty arrays: no receivers.
    SceneSurface() = default;
    /// Copies the data of all vertices of `scene`, in the order of `Scene::vertex_arrays`.
    explicit SceneSurface(const Scene& scene);
    /// Returns a view of the arrays of this object, which must outlive the view.
    ReceiverSurface view() const { return {areas, edges, normals, positions, jumps}; }
};

} // namespace prt
