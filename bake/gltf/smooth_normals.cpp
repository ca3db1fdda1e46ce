// Computes smooth normals for meshes without normals. Thürmer and Wüthrich, "Computing Vertex Normals from
// Polygonal Facets", 1998: weights by angles.

#include "bake/gltf/smooth_normals.h"

#include "runtime/load/triangle_normal.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace prt {
namespace {

/// Maximum number of triangles at one edge that are compared. More than two meet where surfaces touch or are
/// duplicated.
constexpr std::size_t kMaxNeighbours = 8;

/// An edge of a triangle between two positions, `low` < `high`, and the corners at them.
struct SharpEdge {
    std::uint32_t low, high;
    std::size_t low_corner, high_corner; ///< 3 * triangle + corner
    std::pair<std::uint32_t, std::uint32_t> ends() const { return {low, high}; }
};

/// Returns for each vertex the first vertex at the same position.
std::vector<std::uint32_t> welded(std::span<const glm::vec3> positions) {
    std::vector<std::uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
        const glm::vec3 p = positions[v] + 0.0f; // -0 is 0
        return std::array{p.x, p.y, p.z};
    };
    std::ranges::stable_sort(order, {}, key);
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

/// Sets of corners that share a normal.
class CornerSets {
public:
    explicit CornerSets(std::size_t corners) : parents_(corners) {
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    }
    std::size_t find(std::size_t corner) {
        while (parents_[corner] != corner)
            corner = parents_[corner] = parents_[parents_[corner]];
        return corner;
    }
    /// Joins two sets. The smaller root is kept, so that results do not depend on the order.
    void join(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parents_;
};

class Smoother {
public:
    Smoother(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
        : positions_(positions), triangles_(triangles), sets_(3 * triangles.size()) {
        for (const glm::uvec3& t : triangles)
            faces_.emplace_back(unit_or_zero(area_normal(at(t.x), at(t.y), at(t.z))));
    }

    SmoothVertices smooth(double degrees) {
        join_across_edges(std::cos(glm::radians(degrees)) - 1e-6); // normals are floats
        sum_angles();
        SmoothVertices result;
        result.triangles.resize(triangles_.size());
        std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t>
            numbers;                                              // new vertex for each vertex and set
        std::vector<std::uint32_t> any(positions_.size(), kNone); // one new vertex for each vertex
        for (const bool flat : {false, true}) // triangles without area last: they use existing normals
            for (std::size_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
                if ((faces_[corner / 3] == glm::dvec3(0)) != flat)
                    continue;
                const std::uint32_t vertex = vertex_of(corner);
                std::uint32_t& number = result.triangles[corner / 3][static_cast<int>(corner % 3)];
                if (flat && any[vertex] != kNone) {
                    number = any[vertex];
                    continue;
                }
                const auto next = static_cast<std::uint32_t>(result.source.size());
                const auto [found, is_new] = numbers.try_emplace({vertex, sets_.find(corner)}, next);
                if (is_new) {
                    result.source.push_back(vertex);
                    const glm::vec3 normal = unit_or_zero(sums_[sets_.find(corner)]);
                    result.normals.push_back(normal == glm::vec3(0) ? face_or_up(corner) : normal);
                }
                number = any[vertex] = found->second;
            }
        return result;
    }

private:
    static constexpr std::uint32_t kNone = ~0u;

    glm::dvec3 at(std::uint32_t vertex) const { return positions_[vertex]; }
    std::uint32_t vertex_of(std::size_t corner) const {
        return triangles_[corner / 3][static_cast<int>(corner % 3)];
    }
    /// Returns the normal of the triangle, or +Z if it has no area. Used for sets whose normals cancel.
    glm::vec3 face_or_up(std::size_t corner) const {
        const glm::dvec3 face = faces_[corner / 3];
        return face == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(face);
    }

    void join_across_edges(double min_cosine) {
        const std::vector<std::uint32_t> weld = welded(positions_);
        std::vector<SharpEdge> edges;
        for (std::size_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
            const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
            const std::uint32_t a = weld[vertex_of(corner)], b = weld[vertex_of(next)];
            if (a != b && faces_[corner / 3] != glm::dvec3(0))
                edges.push_back(a < b ? SharpEdge{a, b, corner, next} : SharpEdge{b, a, next, corner});
        }
        std::ranges::stable_sort(edges, {}, &SharpEdge::ends);
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t j = i + 1; j < std::min(i + kMaxNeighbours, edges.size()); ++j) {
                if (edges[j].ends() != edges[i].ends())
                    break;
                if (glm::dot(faces_[edges[i].low_corner / 3], faces_[edges[j].low_corner / 3]) < min_cosine)
                    continue;
                sets_.join(edges[i].low_corner, edges[j].low_corner);
                sets_.join(edges[i].high_corner, edges[j].high_corner);
            }
    }

    void sum_angles() {
        sums_.resize(3 * triangles_.size(), glm::dvec3(0));
        for (std::size_t corner = 0; corner < sums_.size(); ++corner) {
            const std::size_t first = corner - corner % 3;
            const glm::dvec3 here = at(vertex_of(corner)),
                             a = at(vertex_of(first + (corner % 3 + 1) % 3)) - here,
                             b = at(vertex_of(first + (corner % 3 + 2) % 3)) - here;
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            sums_[sets_.find(corner)] += angle * faces_[corner / 3];
        }
    }

    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
    std::vector<glm::dvec3> faces_; ///< [triangles] unit normals; zero for triangles without area
    CornerSets sets_;               ///< sets of corners at one position that share a normal
    std::vector<glm::dvec3> sums_;  ///< [corners] sum of normals, stored at the root of each set
};

} // namespace

SmoothVertices smooth_vertices(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                               double degrees) {
    return Smoother(positions, triangles).smooth(degrees);
}

} // namespace prt
