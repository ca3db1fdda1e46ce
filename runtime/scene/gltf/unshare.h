#pragma once

#include "gltf/contents.h"
#include "prt/scene.h"

namespace prt {

/// Makes the file hold the scene's vertices one to one, so that data per receiver can be attached: meshes
/// that several nodes share get a copy per node, and primitives whose vertices were split for flat normals
/// are written anew as triangles. Returns per scene primitive its JSON in `contents`.
std::vector<Json*> unshare(GltfContents& contents, const Scene& scene);

} // namespace prt
