#pragma once

// Helpers of the readers of OBJ and PLY.

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace prt {

/// Returns the file without a byte order mark of UTF-8.
std::string_view without_mark(std::string_view text);

/// Returns the next word, separated by spaces and tabs, and removes it from `line`; empty at the end.
std::string_view next_word(std::string_view& line);

/// Returns the number that `word` consists of; infinite beyond the range of doubles. Throws `Error` for other
/// text.
double number_of(std::string_view word);

/// Cuts a polygon into triangles of its corners (ear clipping in the plane of its mean normal), which are
/// appended to `triangles`. `polygon`: indices of `positions`, at least 3, all valid. Polygons of more than
/// 1024 corners, and what remains of polygons that intersect themselves, are cut into fans.
void append_polygon(std::span<const std::uint32_t> polygon, std::span<const glm::dvec3> positions,
                    std::vector<glm::uvec3>& triangles);

} // namespace prt
