#pragma once

// Splits triangles at their longest edges, without hanging vertices (M.-C. Rivara, "Algorithms for refining
// triangular grids suitable for adaptive and multigrid techniques", International Journal for Numerical
// Methods in Engineering 20, 1984). Angles stay above a bound for any number of splits.

#include "bake/refine/welded_edges.h"
#include "prt/gltf/refinement.h"

#include <glm/vec2.hpp>

#include <array>
#include <vector>

namespace prt {

/// Minimum edge length relative to half the scene's extent. Corners are rounded to at most 2^-24 of the half
/// extent: with edges of 2^-13 of it triangles tilt by at most 2^-11, and rays still start 30 roundings off.
inline constexpr double kMinEdge = 1.0 / 8192;

/// Marks edges of a scene's `WeldedEdges` for splitting. If an edge is marked, the longest edge of each of
/// its triangles is also marked.
class EdgeMarks {
public:
    /// Keeps a reference to `edges`.
    explicit EdgeMarks(const WeldedEdges& edges);
    /// Marks an edge, and all edges that must be split with it.
    void mark(std::uint32_t edge);
    bool marked(std::uint32_t edge) const { return edge != kNoEdge && marked_[edge]; }
    /// Number of vertices that the split adds.
    std::size_t vertices() const { return vertices_; }

private:
    const WeldedEdges& edges_;
    std::vector<bool> marked_;
    std::vector<std::uint32_t> first_, triangles_; ///< triangles of each edge, one list after another
    std::vector<std::uint32_t> sides_;             ///< [edges] number of vertices at the midpoint
    std::size_t vertices_ = 0;
};

/// Returns the edges that cannot be marked without splitting a triangle that `kept` contains: [edges].
std::vector<bool> fixed_edges(const WeldedEdges& edges, const std::vector<bool>& kept);

/// A triangle of the finer scene as a part of the original triangle.
struct Part {
    std::uint32_t whole;               ///< triangle of the original scene
    std::array<glm::dvec2, 3> corners; ///< barycentric coordinates of corners 1 and 2 of `whole`
};

struct Bisection {
    Refinement refinement;   ///< refinement of the original scene
    std::vector<Part> parts; ///< [triangles of the finer scene]
};

/// Splits triangles at their marked edges into two to four.
Bisection bisect(const Scene& scene, const WeldedEdges& edges, const EdgeMarks& marks);

/// Appends `next`, which refines the result of `refinement`, to `refinement`.
void append(Refinement& refinement, Refinement next);

} // namespace prt
