#pragma once

#include "prt/scene.h"

#include <tiny_gltf.h>

#include <vector>

namespace prt {

/// The materials of the file, then the default material of primitives that name none.
std::vector<Material> read_materials(const tinygltf::Model& model);

} // namespace prt
