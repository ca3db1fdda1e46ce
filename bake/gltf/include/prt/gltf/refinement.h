#pragma once

// Mesh refinement: inserts vertices at edge midpoints, in memory and in files. Experimental.

#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/load/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// A new vertex at the midpoint between two vertices of a vertex array. Midpoint i of an array with n
/// vertices becomes vertex n + i.
struct Midpoint {
    /// The two ends, as indices in the vertex array. An end can be an earlier midpoint.
    std::uint32_t first, second;
    friend bool operator==(const Midpoint&, const Midpoint&) = default;
};

/// Describes a refinement of a scene: new vertices, and the triangles that replace those of the scene.
struct Refinement {
    /// [vertex arrays][new vertices] midpoints that are appended to each vertex array.
    std::vector<std::vector<Midpoint>> midpoints;
    /// [primitives][triangles] all triangles of each primitive after the refinement, as vertex indices in the
    /// vertex array, with the winding order of Primitive::triangles.
    std::vector<std::vector<glm::uvec3>> triangles;

    /// Returns the number of new vertices of all vertex arrays.
    std::size_t vertices() const;
};

/// Returns the refinement of `scene` that changes nothing: no new vertices, and the present triangles.
Refinement no_refinement(const Scene& scene);

/// Returns `scene` with `refinement` applied. A new vertex has the means of the positions, texture
/// coordinates and colors of both ends, and the normalised mean of both normals. If the normals are opposite,
/// the new vertex has the normal of the first end. VertexArray::source becomes empty in arrays with new
/// vertices, and receivers are renumbered array by array. Surfaces keep their shape, because triangles stay
/// flat.
Scene refined(const Scene& scene, const Refinement& refinement);

/// Returns `document` with `refinement` applied. `scene` must be extracted from `document`. Each attribute of
/// a new vertex, also in morph targets, is the mean of the attributes of both ends, in the number type of the
/// file, with these exceptions. Normals and tangents of vertices are normalised means; if the ends are
/// opposite, they are those of the first end. Joints are those with the largest weights among the joints of
/// both ends; the sum of their weights is 1. Other integer attributes that are not normalised are copied from
/// the first end. Positions, and texture coordinates in integers that are not normalised, become float32, so
/// that surfaces which touch each other still touch. Each node gets a separate copy of a shared mesh,
/// primitives without normals get flat normals, and transfer is removed. Throws `Error`, with the file name,
/// if `document` is damaged or becomes too large.
GltfDocument refined(GltfDocument document, const Scene& scene, const Refinement& refinement);

/// Returns `shared.document`, a result of `with_shared_meshes` without factors, with `refinement` applied, in
/// the form of `Instancing::nodes`. `stored` must be extracted from `shared.document`; `refinement` must not
/// change the shared meshes. Otherwise like the function above.
GltfDocument refined(SharedDocument shared, const Scene& stored, const Refinement& refinement);

} // namespace prt
