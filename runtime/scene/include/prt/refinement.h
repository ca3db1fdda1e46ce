#pragma once

// Mesh refinement: inserts vertices at edge midpoints, in memory and in files. Experimental.

#include "prt/gltf.h"
#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// A vertex at the midpoint between two vertices of an array. Both may be midpoints that were added before.
struct Midpoint {
    std::uint32_t first, second;
    friend bool operator==(const Midpoint&, const Midpoint&) = default;
};

/// Describes a refinement: vertices appended to the vertex arrays, and the complete new triangles of the
/// primitives, with the winding order of the scene.
struct Refinement {
    std::vector<std::vector<Midpoint>> midpoints;   ///< [vertex arrays]
    std::vector<std::vector<glm::uvec3>> triangles; ///< [primitives]

    /// Returns the number of added vertices.
    std::size_t vertices() const;
};

/// Returns the refinement of `scene` that changes nothing.
Refinement no_refinement(const Scene& scene);

/// Returns the refined scene. Triangles stay flat: positions, texture coordinates and colors are means,
/// normals are normalised means.
Scene refined(const Scene& scene, const Refinement& refinement);

/// Returns the refined file. Every attribute of a midpoint, also in morph targets, is the mean of the two
/// ends, in the type of the file. Normals and tangents are normalised. Joints are those of both ends with the
/// largest weights. Integers of which a mean is meaningless (application attributes) are copied from the
/// first end. Positions and integer texture coordinates become float32, so that surfaces which touch each
/// other still do. `scene` must be extracted from `document`. Meshes are copied for each node, primitives
/// without normals get flat ones, and transfer is removed. Throws `Error`.
GltfDocument refined(GltfDocument document, const Scene& scene, const Refinement& refinement);

} // namespace prt
