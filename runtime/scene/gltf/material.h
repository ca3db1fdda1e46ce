#pragma once

#include "gltf/unit_range.h"
#include "prt/scene.h"

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace prt {

/// Adds the materials of the file to `scene`, then the default material of primitives that name none. The
/// images of the file stand in `scene` already; textures that have none get one without bytes.
void read_materials(const tinygltf::Model& model, Scene& scene, UnitRange& range);

/// What the materials that `scene` uses have and nothing here reads, a line each.
std::vector<std::string> unread_material_notices(const tinygltf::Model& model, const Scene& scene);

} // namespace prt
