#pragma once

// New texture coordinates for primitives, whose vertices are split where charts end. Experimental.

#include "prt/gltf.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Of one primitive.
struct VertexSplit {
    std::vector<std::uint32_t> source; ///< [new vertices] vertex of the scene's vertex array
    std::vector<glm::vec2> uv;         ///< [new vertices]
    std::vector<glm::uvec3> triangles; ///< into the new vertices, as the scene's turn
};

/// The number of the first set of coordinates that no primitive has.
int free_texcoord(const Scene& scene);

/// The file with these coordinates as TEXCOORD_`set`, from which `scene` was extracted: every node has a mesh
/// of its own, and all else that the file says of vertices goes with them. Lower sets that a primitive lacks
/// are zero, since glTF counts sets without gaps.
GltfDocument with_texcoords(GltfDocument document, const Scene& scene, std::span<const VertexSplit> splits,
                            int set);

} // namespace prt
