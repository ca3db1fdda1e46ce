#pragma once

// New texture coordinates for primitives; vertices are split at chart boundaries. Experimental.

#include "prt/gltf.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// New vertices of one primitive.
struct VertexSplit {
    std::vector<std::uint32_t> source; ///< [new vertices] index into the scene's vertex array
    std::vector<glm::vec2> uv;         ///< [new vertices]
    std::vector<glm::uvec3> triangles; ///< indices of new vertices, with the winding order of the scene
};

/// Returns the index of the first set of coordinates that no primitive uses.
int free_texcoord(const Scene& scene);

/// Returns the file with these coordinates as TEXCOORD_`set`; `scene` must be extracted from it. Every node
/// gets a separate mesh, and all other vertex data is split accordingly. Missing lower sets are filled with
/// zero, since glTF requires sets without gaps.
GltfDocument with_texcoords(GltfDocument document, const Scene& scene, std::span<const VertexSplit> splits,
                            int set);

} // namespace prt
