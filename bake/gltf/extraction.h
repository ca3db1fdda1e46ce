#pragma once

// Extraction of a scene with materials, images and lights.

#include "bake/gltf/contents.h"
#include "runtime/load/geometry.h"

namespace prt {

/// `extract_geometry` with images, lights and all properties of materials.
Geometry extract(const GltfContents& contents, Keep keep);
/// `extract_geometry_with_levels` with images, lights and all properties of materials.
Geometry extract_with_levels(const GltfContents& contents);

} // namespace prt
