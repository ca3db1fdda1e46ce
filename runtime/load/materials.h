#pragma once

// Reading of glTF materials without textures.

#include "prt/load/scene.h"
#include "runtime/load/json.h"
#include "runtime/load/unit_range.h"

#include <vector>

namespace prt {

/// Returns the materials of the file, followed by the default material: name, base color, meaning of alpha,
/// and whether they are double-sided.
std::vector<Material> read_base_materials(const Json& json, UnitRange& range);

} // namespace prt
