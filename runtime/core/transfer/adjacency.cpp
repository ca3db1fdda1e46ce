// Edges of meshes as lists of neighbours in compressed sparse rows.
#include "prt/core/adjacency.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace prt {

std::vector<Edge> unique_edges(std::vector<Edge> edges) {
    std::erase_if(edges, [](const Edge& e) { return e.first == e.second; });
    for (Edge& e : edges)
        if (e.first > e.second)
            std::swap(e.first, e.second);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    edges.shrink_to_fit(); // each edge of a mesh usually occurs twice in the input
    return edges;
}

Adjacency::Adjacency(std::span<const Edge> edges, std::size_t receivers)
    : first_(receivers + 1, 0), neighbours_(2 * edges.size()) {
    for (const Edge& e : edges) {
        assert(e.first < receivers && e.second < receivers);
        ++first_[e.first + 1];
        ++first_[e.second + 1];
    }
    for (std::size_t p = 0; p < receivers; ++p)
        first_[p + 1] += first_[p];
    // Edges are sorted, so that a receiver gets its smaller neighbours first, then its larger ones, each in
    // order.
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const Edge& e : edges) {
        neighbours_[next[e.first]++] = e.second;
        neighbours_[next[e.second]++] = e.first;
    }
}

} // namespace prt
