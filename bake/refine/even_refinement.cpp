// Bisects triangles until all edges are short.

#include "bake/refine/even_refinement.h"

#include "bake/refine/bisection.h"

#include <algorithm>

namespace prt {

Scene with_short_edges(const Scene& scene, double longest) {
    Scene even = scene;
    const Bounds box = bounds(scene);
    const glm::vec3 size = box.high - box.low;
    const double shortest = kMinEdge * 0.5 * static_cast<double>(std::max({size.x, size.y, size.z}));
    longest = std::max(longest, 2 * shortest);
    while (true) {
        const WeldedEdges edges = welded_edges(even);
        EdgeMarks marks(edges);
        for (std::uint32_t t = 0; t < edges.of_triangle.size(); ++t) {
            const std::uint32_t edge = edges.of_triangle[t][edges.longest[t]];
            if (edge != kNoEdge && edges.lengths[edge] > longest)
                marks.mark(edge);
        }
        if (marks.vertices() == 0)
            return even;
        even = refined(even, bisect(even, edges, marks).refinement);
    }
}

} // namespace prt
