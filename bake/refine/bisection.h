#pragma once

// Triangles split at their longest edges, without hanging vertices (M.-C. Rivara, "Algorithms for refining
// triangular grids suitable for adaptive and multigrid techniques", International Journal for Numerical
// Methods in Engineering 20, 1984): angles stay above a bound however often they are split.

#include "prt/refinement.h"
#include "refine/welded_edges.h"

#include <glm/vec2.hpp>

#include <array>
#include <vector>

namespace prt {

/// Corners are rounded to 2^-24 of the scene's half extent, or less: over edges of 2^-13 of it triangles lean
/// by 2^-11 at most, and rays still leave them 30 roundings off.
inline constexpr double kLeastEdge = 1.0 / 8192;

/// Edges to split, of a scene's `WeldedEdges`. With an edge that is marked, the longest edge of each of its
/// triangles is.
class EdgeMarks {
public:
    /// Keeps a reference to `edges`.
    explicit EdgeMarks(const WeldedEdges& edges);
    /// Marks an edge, and what must be split with it.
    void mark(std::uint32_t edge);
    bool marked(std::uint32_t edge) const { return edge != kNoEdge && marked_[edge]; }
    /// How many vertices splitting adds.
    std::size_t vertices() const { return vertices_; }

private:
    const WeldedEdges& edges_;
    std::vector<bool> marked_;
    std::vector<std::uint32_t> first_, triangles_; ///< of each edge its triangles, one list after the other
    std::vector<std::uint32_t> sides_;             ///< [edges] how many vertices its middle has
    std::size_t vertices_ = 0;
};

/// A triangle of the finer scene, in the one that it is a part of.
struct Part {
    std::uint32_t whole;               ///< triangle of the scene before
    std::array<glm::dvec2, 3> corners; ///< barycentric coordinates of corners 1 and 2 of `whole`
};

struct Bisection {
    Refinement refinement;   ///< of the scene before
    std::vector<Part> parts; ///< [triangles of the finer scene]
};

/// Splits triangles in two to four at their marked edges.
Bisection bisect(const Scene& scene, const WeldedEdges& edges, const EdgeMarks& marks);

/// What `refinement` and then `next`, of the scene that it makes, are together.
void append(Refinement& refinement, Refinement next);

} // namespace prt
