#pragma once

// Packs rectangles into a square.

#include <glm/vec2.hpp>

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Packs rectangles next to each other in a square. Returns the corner of each; no value if they do not fit.
std::optional<std::vector<glm::ivec2>> pack_rectangles(std::span<const glm::ivec2> sizes, int side);

} // namespace prt
