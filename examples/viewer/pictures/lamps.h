#pragma once

// Strengths of the lamps of a model.

#include "prt/core/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A lamp of the model (`TransferTerm`), identified by its name.
struct LampControl {
    std::string name;
    bool on = true;
    float strength = 1; ///< 1: as in the scene
    glm::vec3 color{1}; ///< factor on its light, linear Rec. 709

    friend bool operator==(const LampControl&, const LampControl&) = default;
};

struct LampSettings {
    bool on = true;
    float strength = 1; ///< factor on the strength of every lamp
    std::vector<LampControl> each = {};

    friend bool operator==(const LampSettings&, const LampSettings&) = default;
};

/// Maximum strength; it keeps emission within the range of floats.
inline constexpr float kMaxLampStrength = 1e9f;

/// Returns the lamps of the layouts, each name once. Lamps in `known` keep their settings; new ones have the
/// strength of the scene.
std::vector<LampControl> lamps_of(std::span<const prt::TransferLayout* const> layouts,
                                  const std::vector<LampControl>& known);

/// Returns the strength of each lamp of `layout`, matched by name; 0 if it is off, or if all lamps are off.
std::vector<glm::vec3> strengths_of(const LampSettings& settings, const prt::TransferLayout& layout);

/// True if at least one lamp gives light.
bool any_shines(const LampSettings& settings);

/// Returns `lighting` with these strengths for the lamps of `layout`.
prt::Lighting with_lamps(prt::Lighting lighting, const LampSettings& settings,
                         const prt::TransferLayout& layout);

} // namespace viewer
