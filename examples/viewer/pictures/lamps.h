#pragma once

// How bright the lamps of a model are set.

#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A lamp of the model (`TransferPart`), by its name.
struct Lamp {
    std::string name;
    bool on = true;
    float strength = 1; ///< 1: as in the scene
    glm::vec3 color{1}; ///< what its light is multiplied with, linear Rec. 709

    friend bool operator==(const Lamp&, const Lamp&) = default;
};

struct LampSettings {
    bool on = true;
    float strength = 1; ///< what that of every lamp is multiplied with
    std::vector<Lamp> each = {};

    friend bool operator==(const LampSettings&, const LampSettings&) = default;
};

/// The largest strength; what shines stays within what floats hold.
inline constexpr float kMostLampStrength = 1e9f;

/// Those that the layouts have, each name once, as `known` has them set; new ones shine as in the scene.
std::vector<Lamp> lamps_of(std::span<const prt::TransferLayout* const> layouts,
                           const std::vector<Lamp>& known);

/// Of each lamp of `layout`, by name; 0 where it is off, or all are.
std::vector<glm::vec3> strengths_of(const LampSettings& settings, const prt::TransferLayout& layout);

/// Whether one of them gives light.
bool any_shines(const LampSettings& settings);

/// `lighting` with the lamps of `layout` set so.
prt::Lighting with_lamps(prt::Lighting lighting, const LampSettings& settings,
                         const prt::TransferLayout& layout);

} // namespace viewer
