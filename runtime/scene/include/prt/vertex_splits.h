#pragma once

// New texture coordinates for primitives; vertices are split at chart boundaries. Experimental.

#include "prt/gltf.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// New vertices and texture coordinates of one primitive.
struct VertexSplit {
    std::vector<std::uint32_t> source; ///< [new vertices] index in the primitive's vertex array
    std::vector<glm::vec2> uv;         ///< [new vertices]
    std::vector<glm::uvec3> triangles; ///< indices of new vertices, with the winding order of the scene
};

/// Returns the smallest N for which no primitive has TEXCOORD_N or a later set.
int free_texcoord(const Scene& scene);

/// Returns the file with the coordinates of `splits` [primitives of the scene] as TEXCOORD_`set`. All other
/// vertex data is split accordingly, and every node gets a separate mesh. Missing sets below `set` are filled
/// with zero, because glTF does not allow gaps. `scene` must be extracted from `document`.
GltfDocument with_texcoords(GltfDocument document, const Scene& scene, std::span<const VertexSplit> splits,
                            int set);

} // namespace prt
