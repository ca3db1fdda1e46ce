#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace prt {

/// What a name says of a level of detail: "Rock_LOD1", "rock lod_1" and "Rock-LOD1.002" (as Blender numbers
/// copies) are level 1 of "rock_", "rock " and "rock-.002".
struct LevelName {
    std::string stem; ///< in small letters
    int level = 0;    ///< 0..99
};
std::optional<LevelName> level_name(std::string_view name);

} // namespace prt
