#pragma once

// Finer meshes: vertices in the middle of edges, in memory and in files. Experimental.

#include "prt/gltf.h"
#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// The middle between two vertices of an array, which may be middles themselves that come before it.
struct Midpoint {
    std::uint32_t first, second;
    friend bool operator==(const Midpoint&, const Midpoint&) = default;
};

/// What makes a scene finer: vertices that its vertex arrays get behind those they have, and all triangles
/// that its primitives have then, turned as the scene's are.
struct Refinement {
    std::vector<std::vector<Midpoint>> midpoints;   ///< [vertex arrays]
    std::vector<std::vector<glm::uvec3>> triangles; ///< [primitives]

    /// How many vertices it adds.
    std::size_t vertices() const;
};

/// The one that changes nothing.
Refinement no_refinement(const Scene& scene);

/// The finer scene. Triangles stay flat: positions, texture coordinates and colors are means, normals the
/// unit ones of means.
Scene refined(const Scene& scene, const Refinement& refinement);

/// The finer file. Every attribute of a vertex in the middle is the mean of the two ends, in the type that
/// the file has: normals and tangents are made unit, morph targets are means, joints are those of both ends
/// of which the heaviest stay, whole numbers that are no measures (attributes of applications) are those of
/// the first end. Positions, and texture coordinates that are whole numbers, become float32, so that what
/// touches still does. `scene` is extracted from `document`, whose meshes get a copy for each node, whose
/// primitives without normals get flat ones, and whose transfer is taken out. Throws `Error`.
GltfDocument refined(GltfDocument document, const Scene& scene, const Refinement& refinement);

} // namespace prt
