// Longest-edge refinement: marks spread to longest edges, then each triangle is split at its marked edges.

#include "bake/refine/bisection.h"

#include <algorithm>
#include <numeric>

namespace prt {
namespace {

/// A corner of a triangle or the midpoint of an edge.
struct Point {
    std::uint32_t vertex; ///< index in its vertex array
    glm::dvec2 at;        ///< barycentric coordinates in the whole triangle
};

class Splitter {
public:
    Splitter(const Scene& scene, const WeldedEdges& edges, const EdgeMarks& marks)
        : scene_(scene), edges_(edges), marks_(marks), middles_(edges.sides.size()) {}

    Bisection split() {
        result_.refinement.midpoints.resize(scene_.vertex_arrays.size());
        for (std::size_t i = 0; i < edges_.sides.size(); ++i) {
            const WeldedEdges::Sides& sides = edges_.sides[i];
            if (!marks_.marked(sides.edge))
                continue;
            auto& midpoints = result_.refinement.midpoints[sides.array];
            middles_[i] =
                static_cast<std::uint32_t>(scene_.vertex_arrays[sides.array].size() + midpoints.size());
            midpoints.push_back({sides.first, sides.second});
        }
        for (const Primitive& primitive : scene_.primitives) {
            triangles_ = &result_.refinement.triangles.emplace_back();
            for (const glm::uvec3& t : primitive.triangles)
                split(t);
        }
        return std::move(result_);
    }

private:
    /// Splits a triangle from the midpoint of its longest edge to the opposite corner, then each half from
    /// there to the midpoint of its other original edge.
    void split(const glm::uvec3& t) {
        constexpr glm::dvec2 kCorners[3] = {{0, 0}, {1, 0}, {0, 1}};
        const std::size_t l = edges_.longest[whole_], m = (l + 1) % 3, n = (l + 2) % 3;
        const auto corner = [&](std::size_t i) { return Point{t[static_cast<int>(i)], kCorners[i]}; };
        const Point a = corner(l), b = corner(m), c = corner(n);
        if (!is_marked(l)) {
            add(corner(0), corner(1), corner(2));
        } else {
            const Point ab = middle(l, a, b);
            if (is_marked(n)) {
                const Point ca = middle(n, c, a);
                add(a, ab, ca);
                add(ab, c, ca);
            } else {
                add(a, ab, c);
            }
            if (is_marked(m)) {
                const Point bc = middle(m, b, c);
                add(ab, b, bc);
                add(ab, bc, c);
            } else {
                add(ab, b, c);
            }
        }
        ++whole_;
    }

    bool is_marked(std::size_t i) const { return marks_.marked(edges_.of_triangle[whole_][i]); }

    Point middle(std::size_t i, const Point& from, const Point& to) const {
        return {middles_[edges_.sides_of_triangle[whole_][i]], 0.5 * (from.at + to.at)};
    }

    void add(const Point& a, const Point& b, const Point& c) {
        triangles_->push_back({a.vertex, b.vertex, c.vertex});
        result_.parts.push_back({whole_, {a.at, b.at, c.at}});
    }

    const Scene& scene_;
    const WeldedEdges& edges_;
    const EdgeMarks& marks_;
    std::vector<std::uint32_t> middles_; ///< [sides] index of the midpoint in its vertex array
    std::vector<glm::uvec3>* triangles_ = nullptr;
    std::uint32_t whole_ = 0;
    Bisection result_;
};

} // namespace

EdgeMarks::EdgeMarks(const WeldedEdges& edges)
    : edges_(edges), marked_(edges.lengths.size()), first_(edges.lengths.size() + 1),
      sides_(edges.lengths.size()) {
    for (const auto& of : edges.of_triangle)
        for (const std::uint32_t e : of)
            if (e != kNoEdge)
                ++first_[e + 1];
    for (std::size_t e = 0; e + 1 < first_.size(); ++e)
        first_[e + 1] += first_[e];
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < edges.of_triangle.size(); ++t)
        for (const std::uint32_t e : edges.of_triangle[t])
            if (e != kNoEdge)
                triangles_[next[e]++] = t;
    for (const WeldedEdges::Sides& sides : edges.sides)
        ++sides_[sides.edge];
}

void EdgeMarks::mark(std::uint32_t edge) {
    std::vector<std::uint32_t> waiting = {edge}; // each next edge is longer, so that the loop ends
    while (!waiting.empty()) {
        const std::uint32_t e = waiting.back();
        waiting.pop_back();
        if (e == kNoEdge || marked_[e])
            continue;
        marked_[e] = true;
        vertices_ += sides_[e];
        for (std::uint32_t i = first_[e]; i < first_[e + 1]; ++i)
            waiting.push_back(edges_.of_triangle[triangles_[i]][edges_.longest[triangles_[i]]]);
    }
}

std::vector<bool> fixed_edges(const WeldedEdges& edges, const std::vector<bool>& kept) {
    std::vector<std::uint32_t> order(edges.of_triangle.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto longest = [&](std::uint32_t t) { return edges.of_triangle[t][edges.longest[t]]; };
    std::erase_if(order, [&](std::uint32_t t) { return longest(t) == kNoEdge; });
    // Marks spread to longer edges, so that triangles with the longest edges are decided first.
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const double x = edges.lengths[longest(a)], y = edges.lengths[longest(b)];
        return x != y ? x > y : longest(a) > longest(b);
    });
    std::vector<bool> fixed(edges.lengths.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        // All triangles with one longest edge: a kept one fixes it before the others read it.
        while (last < order.size() && longest(order[last]) == longest(order[first]))
            if (kept[order[last++]])
                fixed[longest(order[first])] = true;
        for (std::size_t i = first; i < last; ++i)
            for (const std::uint32_t e : edges.of_triangle[order[i]])
                if (e != kNoEdge && (kept[order[i]] || fixed[longest(order[i])]))
                    fixed[e] = true;
    }
    return fixed;
}

Bisection bisect(const Scene& scene, const WeldedEdges& edges, const EdgeMarks& marks) {
    return Splitter(scene, edges, marks).split();
}

void append(Refinement& refinement, Refinement next) {
    for (std::size_t a = 0; a < refinement.midpoints.size(); ++a)
        refinement.midpoints[a].insert(refinement.midpoints[a].end(), next.midpoints[a].begin(),
                                       next.midpoints[a].end());
    refinement.triangles = std::move(next.triangles);
}

} // namespace prt
