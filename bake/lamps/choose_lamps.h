#pragma once

// Which lights of a scene are dimmed together.

#include "prt/bake.h"
#include "prt/surfaces.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Lights and shining surfaces of one name, or of one group.
struct Lamp {
    std::string name;
    std::vector<std::string> members = {};     ///< of a group: the names in it
    std::vector<std::uint32_t> lights = {};    ///< indices into Scene::lights
    std::vector<std::uint32_t> triangles = {}; ///< that shine
};

/// All lamps of the scene, in the order of their first member: those of `options.groups` under the names of
/// the groups, each other one under its own; none in `LampMode::none`. Throws `Error` for a pattern that no
/// lamp has and for more than kMostLamps.
std::vector<Lamp> choose_lamps(const Surfaces& surfaces, const LampOptions& options);

/// Whether all that `lamps` give off is white.
bool are_white(const Surfaces& surfaces, const std::vector<Lamp>& lamps);

/// `pattern` with * for any letters, ? for any one.
bool matches(const std::string& text, const std::string& pattern);

} // namespace prt
