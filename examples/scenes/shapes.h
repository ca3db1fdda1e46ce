#pragma once

// Architectural surfaces and surfaces of revolution, with vertices about kShapeSpacing from each other.

#include "mesh.h"

#include <span>

namespace examples {

inline constexpr float kShapeSpacing = 0.17f; ///< metres

/// Returns a smooth surface through rows with equal numbers of points; its front is along row x next row. A
/// row that ends at its first point is a closed ring; all its points may be equal (a pole). Texture
/// coordinates are lengths in metres.
Mesh lofted(const std::vector<std::vector<glm::vec3>>& rows);

/// A line of points. It is smooth, except at duplicate points, which are edges.
using Outline = std::vector<glm::vec2>;

/// Returns the surface of an outline of (radius, height) rotated about the vertical through `base`; the
/// outline runs upwards on the outside.
Mesh lathe(const glm::vec3& base, const Outline& outline, int segments);

/// Returns the surface of an outline of (apothem, height) along a regular polygon; its sides are flat.
Mesh polygonal_lathe(const glm::vec3& base, const Outline& outline, int sides);

/// Frame of an outline on a path: the outline's axes are `out` and `up`, and the path is along up x out.
struct Station {
    glm::vec3 origin, out, up;
};

/// Returns the surface of an outline of (out, up) swept along a path; the outline runs upwards on the
/// outside.
Mesh moulding(const Outline& outline, std::span<const Station> way);

/// Returns stations on the straight path from `from` to `to`; `out` is to its right, up is +Y.
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
