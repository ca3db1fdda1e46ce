// Numbers the edges of a scene by the positions of their ends.

#include "bake/refine/welded_edges.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <tuple>

namespace prt {
namespace {

/// Returns an index for each receiver, equal for equal positions, in the order of positions.
std::vector<std::uint32_t> positions_of(const Scene& scene) {
    struct Welded {
        glm::vec3 at;
        std::uint32_t receiver;
        auto key() const { return std::tuple(at.x, at.y, at.z); } // 0 and -0 are equal
    };
    std::vector<Welded> all;
    all.reserve(scene.receivers());
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& at : vertices.positions)
            all.push_back({at, static_cast<std::uint32_t>(all.size())});
    std::sort(all.begin(), all.end(), [](const Welded& a, const Welded& b) {
        return a.key() != b.key() ? a.key() < b.key() : a.receiver < b.receiver;
    });
    std::vector<std::uint32_t> points(all.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        number += i > 0 && all[i].key() != all[i - 1].key() ? 1 : 0;
        points[all[i].receiver] = number;
    }
    return points;
}

/// An edge of a triangle from one corner to the next.
struct Corner {
    WeldedEdges::Sides sides;
    std::uint32_t low, high; ///< indices of positions
    double length;
    std::size_t at; ///< 3 · triangle + corner

    auto key_of_sides() const { return std::tuple(sides.array, sides.first, sides.second); }
    auto key_of_edge() const { return std::tuple(low, high); }
};

std::vector<Corner> corners_of(const Scene& scene) {
    const std::vector<std::uint32_t> points = positions_of(scene);
    std::vector<Corner> corners;
    corners.reserve(3 * scene.triangles());
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        for (const glm::uvec3& t : primitive.triangles)
            for (int i = 0; i < 3; ++i) {
                const auto [first, second] = std::minmax(t[i], t[(i + 1) % 3]);
                const auto [low, high] = std::minmax(points[vertices.first_receiver + first],
                                                     points[vertices.first_receiver + second]);
                corners.push_back({{static_cast<std::uint32_t>(primitive.vertices), first, second, kNoEdge},
                                   low,
                                   high,
                                   glm::distance(glm::dvec3(vertices.positions[first]),
                                                 glm::dvec3(vertices.positions[second])),
                                   corners.size()});
            }
    }
    return corners;
}

} // namespace

WeldedEdges welded_edges(const Scene& scene) {
    WeldedEdges edges;
    std::vector<Corner> corners = corners_of(scene);
    const std::size_t triangles = corners.size() / 3;
    edges.of_triangle.assign(triangles, {kNoEdge, kNoEdge, kNoEdge});
    edges.sides_of_triangle = edges.of_triangle;
    std::erase_if(corners, [](const Corner& c) { return c.low == c.high; });

    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return a.key_of_edge() != b.key_of_edge() ? a.key_of_edge() < b.key_of_edge() : a.at < b.at;
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i == 0 || corners[i].key_of_edge() != corners[i - 1].key_of_edge())
            edges.lengths.push_back(corners[i].length);
        corners[i].sides.edge = static_cast<std::uint32_t>(edges.lengths.size() - 1);
        edges.of_triangle[corners[i].at / 3][corners[i].at % 3] = corners[i].sides.edge;
    }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return a.key_of_sides() != b.key_of_sides() ? a.key_of_sides() < b.key_of_sides() : a.at < b.at;
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i == 0 || corners[i].key_of_sides() != corners[i - 1].key_of_sides())
            edges.sides.push_back(corners[i].sides);
        edges.sides_of_triangle[corners[i].at / 3][corners[i].at % 3] =
            static_cast<std::uint32_t>(edges.sides.size() - 1);
    }
    for (const std::array<std::uint32_t, 3>& of : edges.of_triangle) {
        const auto longer = [&](std::uint8_t a, std::uint8_t b) { // one order over the whole scene
            if (of[a] == kNoEdge || of[b] == kNoEdge)
                return of[a] != kNoEdge;
            const double x = edges.lengths[of[a]], y = edges.lengths[of[b]];
            return x != y ? x > y : of[a] > of[b];
        };
        std::uint8_t longest = 0;
        for (const std::uint8_t i : {std::uint8_t{1}, std::uint8_t{2}})
            if (longer(i, longest))
                longest = i;
        edges.longest.push_back(longest);
    }
    return edges;
}

} // namespace prt
