#pragma once

// Extraction of a scene with materials, images and lights.

#include "bake/gltf/contents.h"
#include "prt/gltf/levels.h"
#include "runtime/load/geometry.h"

namespace prt {

/// `extract_geometry` with images, lights and all properties of materials.
Geometry extract(const GltfContents& contents, Keep keep);
/// `extract_geometry_with_levels` with images, lights and all properties of materials.
Geometry extract_with_levels(const GltfContents& contents, Keep keep);
/// Returns the scene of `geometry` with the levels of its nodes.
LeveledScene leveled_scene(const GltfContents& contents, Geometry geometry);

} // namespace prt
