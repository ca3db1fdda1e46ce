#pragma once

// Reading of glTF materials.

#include "prt/load/scene.h"
#include "runtime/load/unit_range.h"

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace prt {

/// Adds textures and the properties that matter for light to the materials of `scene`, which are those of
/// `read_base_materials`. The images of the file must be in `scene` already; textures without an image get an
/// empty one.
void read_materials(const tinygltf::Model& model, Scene& scene, UnitRange& range);

/// Returns the ignored properties of the materials that `scene` uses, one line each.
std::vector<std::string> unread_material_notices(const tinygltf::Model& model, const Scene& scene);

} // namespace prt
