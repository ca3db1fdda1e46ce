#pragma once

// Separate meshes for nodes.

#include "gltf/contents.h"
#include "prt/scene.h"

namespace prt {

/// Makes the file hold the scene's vertices one to one, so that data per receiver can be attached: meshes
/// that several nodes share are copied per node, and primitives whose vertices were split for flat normals
/// are rewritten as triangles. Returns the JSON of each scene primitive in `contents`.
std::vector<Json*> unshare(GltfContents& contents, const Scene& scene);

} // namespace prt
