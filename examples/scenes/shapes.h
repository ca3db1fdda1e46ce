#pragma once

// Surfaces of masons, turners and smiths, with vertices about kShapeSpacing apart.

#include "mesh.h"

#include <span>

namespace examples {

inline constexpr float kShapeSpacing = 0.17f; ///< metres

/// A smooth surface through rows of equally many points, front where along a row x from row to row points. A
/// row that ends where it begins is a closed ring; all its points may be one, a pole. Texture coordinates are
/// lengths in metres.
Mesh lofted(const std::vector<std::vector<glm::vec3>>& rows);

/// An outline is a line of points, smooth but for those that stand there twice: edges.
using Outline = std::vector<glm::vec2>;

/// An outline of (radius, height), from below to above outside, turned about the vertical through `base`.
Mesh lathe(const glm::vec3& base, const Outline& outline, int segments);

/// An outline of (apothem, height) led round a regular polygon instead, whose sides are flat.
Mesh polygonal_lathe(const glm::vec3& base, const Outline& outline, int sides);

/// Where an outline stands on its way: the outline's axes are `out` and `up`, the way goes along up x out.
struct Station {
    glm::vec3 origin, out, up;
};

/// An outline of (out, up), from below to above outside, led along a way.
Mesh moulding(const Outline& outline, std::span<const Station> way);

/// Stations on the straight way from `from` to `to`; `out` is to the right of it, up is +Y.
std::vector<Station> straight_way(const glm::vec3& from, const glm::vec3& to);

/// The six faces of a box.
Mesh box(const glm::vec3& low, const glm::vec3& high, float spacing = kShapeSpacing);

/// A round bar through points, of a radius at each.
Mesh bar(std::span<const glm::vec3> points, std::span<const float> radii, int segments);

/// A round bar of one radius.
Mesh bar(const glm::vec3& from, const glm::vec3& to, float radius, int segments = 6);

Mesh sphere(const glm::vec3& center, float radius, int segments);

/// An opening of a wall, from `low` to `high` in its (x, y).
struct Opening {
    glm::vec2 low, high;
};

/// The rectangle from `low` to `high` of the plane z = 0, facing +z, with openings, welded throughout.
Mesh wall_with_openings(const glm::vec2& low, const glm::vec2& high, std::span<const Opening> openings,
                        float spacing = kShapeSpacing);

} // namespace examples
