#pragma once

#include <glm/vec2.hpp>

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Places rectangles beside each other in a square: the corner of each, or nothing where they do not fit.
std::optional<std::vector<glm::ivec2>> pack_rectangles(std::span<const glm::ivec2> sizes, int side);

} // namespace prt
