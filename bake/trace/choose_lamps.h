#pragma once

// Groups the lights of a scene into lamps that are dimmed together.

#include "bake/scene/surfaces.h"
#include "prt/bake/bake_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Lights and emissive surfaces of one name or of one group.
struct Lamp {
    std::string name;
    std::vector<std::string> members = {};     ///< names in a group
    std::vector<std::uint32_t> lights = {};    ///< indices into Scene::lights
    std::vector<std::uint32_t> triangles = {}; ///< emissive triangles
};

/// Returns all lamps of the scene, in the order of their first members. Members of `options.groups` have the
/// name of their group, other lamps their own name. The result is empty in `LampMode::none`. Throws `Error`
/// for a pattern that matches no lamp, and for more than kMaxLamps.
std::vector<Lamp> choose_lamps(const Surfaces& surfaces, const LampOptions& options);

/// Whether all light of `lamps` is white.
bool are_white(const Surfaces& surfaces, const std::vector<Lamp>& lamps);

/// Whether `text` matches `pattern`, where * stands for any letters and ? for one.
bool matches(const std::string& text, const std::string& pattern);

} // namespace prt
