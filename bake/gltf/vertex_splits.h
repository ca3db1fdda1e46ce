#pragma once

// New texture coordinates for primitives; vertices are split at chart boundaries. Experimental.

#include "prt/gltf/gltf.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// New vertices, texture coordinates and triangles of one primitive. A vertex at the boundary of charts
/// (parts of a texture) occurs once for each chart.
struct VertexSplit {
    /// [new vertices] index of the original vertex in the vertex array of the primitive.
    std::vector<std::uint32_t> source;
    std::vector<glm::vec2> uv; ///< [new vertices] texture coordinates, as in glTF; 0..1 is the texture
    std::vector<glm::uvec3> triangles; ///< all triangles of the primitive, as indices of new vertices, with
                                       ///< the winding order of Primitive::triangles
};

/// Returns the smallest N for which no vertex array of `scene` has TEXCOORD_N or a later set. 0 if there are
/// no texture coordinates.
int free_texcoord(const Scene& scene);

/// Returns `document` with the vertices and triangles of `splits`, [primitives of `scene`], and with the
/// texture coordinates of `splits` as TEXCOORD_`set`. All other vertex data is copied for the new vertices.
/// Sets below `set` that a primitive lacks are filled with zeros, because glTF does not allow gaps. `scene`
/// must be extracted from `document`. Each node gets a separate copy of a shared mesh, primitives without
/// normals get flat normals, and transfer is removed. Throws `Error`, with the file name, if `document` is
/// damaged or becomes too large.
GltfDocument with_texcoords(GltfDocument document, const Scene& scene, std::span<const VertexSplit> splits,
                            int set);

} // namespace prt
