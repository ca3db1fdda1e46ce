#pragma once

// Reading of glTF materials.

#include "prt/gltf/scene.h"
#include "runtime/scene/gltf/unit_range.h"

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace prt {

/// Adds the materials of the file to `scene`, then the default material. The images of the file must be in
/// `scene` already; textures without an image get an empty one.
void read_materials(const tinygltf::Model& model, Scene& scene, UnitRange& range);

/// Returns the ignored properties of the materials that `scene` uses, one line each.
std::vector<std::string> unread_material_notices(const tinygltf::Model& model, const Scene& scene);

} // namespace prt
