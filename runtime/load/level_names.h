#pragma once

// Names of levels of detail.

#include <optional>
#include <string>
#include <string_view>

namespace prt {

/// Level of detail in a node name: "Rock_LOD1", "rock lod_1" and "Rock-LOD1.002" (Blender's numbering of
/// copies) are level 1 of "rock_", "rock " and "rock-.002".
struct LevelName {
    std::string stem; ///< in lower case
    int level = 0;    ///< 0..99
};
std::optional<LevelName> level_name(std::string_view name);

} // namespace prt
