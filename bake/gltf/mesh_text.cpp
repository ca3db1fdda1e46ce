// Parses words and cuts polygons.

#include "bake/gltf/mesh_text.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace prt {
namespace {

constexpr std::size_t kMaxCorners = 1024; ///< of polygons whose ears are searched, in quadratic time

double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Returns the corners in a plane, so that the polygon has a positive area.
std::vector<glm::dvec2> in_plane(std::span<const std::uint32_t> polygon,
                                 std::span<const glm::dvec3> positions) {
    const glm::dvec3 first = positions[polygon[0]];
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < polygon.size(); ++i)
        normal +=
            glm::cross(positions[polygon[i]] - first, positions[polygon[(i + 1) % polygon.size()]] - first);
    const glm::dvec3 size = glm::abs(normal);
    const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    std::vector<glm::dvec2> corners;
    for (const std::uint32_t index : polygon) {
        const glm::dvec3 p = positions[index] - first;
        corners.push_back(normal[drop] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
    }
    return corners;
}

} // namespace

std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf"))
        text.remove_prefix(3);
    return text;
}

std::string_view next_word(std::string_view& line) {
    constexpr std::string_view kSpace = " \t\r";
    const std::size_t begin = std::min(line.find_first_not_of(kSpace), line.size());
    const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

double number_of(std::string_view word) {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range && end == digits.data() + digits.size())
        return digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos
                   ? 0
                   : HUGE_VAL;
    if (error != std::errc() || end != digits.data() + digits.size() || digits.empty())
        throw Error("has '" + printable(std::string(word.substr(0, 40))) + "' where a number should be");
    return value;
}

void append_polygon(std::span<const std::uint32_t> polygon, std::span<const glm::dvec3> positions,
                    std::vector<glm::uvec3>& triangles) {
    std::vector<std::uint32_t> left(polygon.begin(), polygon.end());
    if (left.size() > 3 && left.size() <= kMaxCorners) {
        std::vector<glm::dvec2> at = in_plane(polygon, positions);
        const auto is_ear = [&](std::size_t i) {
            const std::size_t n = left.size(), before = (i + n - 1) % n, after = (i + 1) % n;
            if (!(area(at[before], at[i], at[after]) > 0))
                return false;
            for (std::size_t k = 0; k < n; ++k)
                if (k != before && k != i && k != after && area(at[before], at[i], at[k]) >= 0 &&
                    area(at[i], at[after], at[k]) >= 0 && area(at[after], at[before], at[k]) >= 0)
                    return false;
            return true;
        };
        for (std::size_t i = 0, tried = 0; left.size() > 3 && tried < left.size();) {
            i %= left.size();
            if (!is_ear(i)) {
                ++i;
                ++tried;
                continue;
            }
            const std::size_t n = left.size();
            triangles.emplace_back(left[(i + n - 1) % n], left[i], left[(i + 1) % n]);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            at.erase(at.begin() + static_cast<std::ptrdiff_t>(i));
            tried = 0;
        }
    }
    for (std::size_t i = 2; i < left.size(); ++i)
        triangles.emplace_back(left[0], left[i - 1], left[i]);
}

} // namespace prt
