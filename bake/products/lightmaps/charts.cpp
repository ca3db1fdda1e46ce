// Maps triangles to the texels of an atlas.

#include "bake/products/lightmaps/charts.h"

#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

/// Tolerance at the border of a texture, because programs round coordinates there.
constexpr double kOutside = 1e-4;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

glm::dvec2 checked(const glm::dvec2& at, const glm::dvec2& tile, const Primitive& primitive,
                   const Atlas& atlas) {
    const glm::dvec2 uv = at - tile;
    for (int axis = 0; axis < 2; ++axis)
        if (!(uv[axis] >= -kOutside && uv[axis] <= 1 + kOutside))
            throw Error(fmt::format(
                "mesh {} primitive {}: a triangle crosses the border of the texture, because "
                "TEXCOORD_{} is ({:.4g}, {:.4g}), not in 0..1; use another set (--texels ...,uv=N) or "
                "a generated one (--texels ...,unwrap)",
                primitive.mesh, primitive.primitive, atlas.uv_set, at.x, at.y));
    return glm::dvec2(std::clamp(uv.x, 0.0, 1.0) * atlas.width, std::clamp(uv.y, 0.0, 1.0) * atlas.height);
}

/// Textures repeat: returns the corner of the square that contains the centroid of the triangle.
glm::dvec2 tile_of(const std::vector<glm::vec2>& uv, const glm::uvec3& t) {
    return glm::floor((glm::dvec2(uv[t.x]) + glm::dvec2(uv[t.y]) + glm::dvec2(uv[t.z])) / 3.0);
}

/// Returns the coordinates that an atlas uses. Throws `Error` if there are none.
const std::vector<glm::vec2>& coordinates(const Scene& scene, const Primitive& primitive, int uv_set) {
    const auto& sets = scene.vertex_arrays[primitive.vertices].texcoords;
    const auto set = static_cast<std::size_t>(uv_set);
    if (set >= sets.size() || sets[set].empty())
        throw Error(fmt::format("mesh {} primitive {} has no TEXCOORD_{}; use another set (--texels "
                                "...,uv=N) or a generated one (--texels ...,unwrap)",
                                primitive.mesh, primitive.primitive, uv_set));
    return sets[set];
}

} // namespace

std::vector<ChartTriangle> chart_triangles(const Scene& scene, const Atlas& atlas) {
    std::vector<std::uint32_t> first;
    std::uint32_t triangles = 0;
    for (const Primitive& primitive : scene.primitives) {
        first.push_back(triangles);
        triangles += static_cast<std::uint32_t>(primitive.triangles.size());
    }
    std::vector<ChartTriangle> result;
    for (const std::size_t p : atlas.primitives) {
        const Primitive& primitive = scene.primitives[p];
        const std::vector<glm::vec2>& uv = coordinates(scene, primitive, atlas.uv_set);
        for (std::size_t t = 0; t < primitive.triangles.size(); ++t) {
            ChartTriangle chart{first[p] + static_cast<std::uint32_t>(t), {}};
            const glm::dvec2 tile = tile_of(uv, primitive.triangles[t]);
            for (int i = 0; i < 3; ++i)
                chart.corners[static_cast<std::size_t>(i)] =
                    checked(glm::dvec2(uv[primitive.triangles[t][i]]), tile, primitive, atlas);
            result.push_back(chart);
        }
    }
    return result;
}

bool repeats(const Scene& scene, const Atlas& atlas) {
    return std::ranges::any_of(atlas.primitives, [&](std::size_t p) {
        const Primitive& primitive = scene.primitives[p];
        const std::vector<glm::vec2>& uv = coordinates(scene, primitive, atlas.uv_set);
        return std::ranges::any_of(primitive.triangles,
                                   [&](const glm::uvec3& t) { return tile_of(uv, t) != glm::dvec2(0); });
    });
}

InTriangle in_triangle(const ChartTriangle& triangle, const glm::dvec2& point) {
    const auto& [a, b, c] = triangle.corners;
    const double area = cross(b - a, c - a);
    if (area == 0)
        return {};
    InTriangle result{{cross(point - a, c - a) / area, cross(b - a, point - a) / area},
                      std::numeric_limits<double>::infinity()};
    const double weights[] = {1 - result.uv.x - result.uv.y, result.uv.x, result.uv.y};
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2 edge = triangle.corners[static_cast<std::size_t>((i + 2) % 3)] -
                                triangle.corners[static_cast<std::size_t>((i + 1) % 3)];
        result.depth = std::min(result.depth, weights[i] * std::abs(area) / glm::length(edge));
    }
    return result;
}

glm::dvec2 nearest_in_triangle(const ChartTriangle& triangle, const glm::dvec2& point) {
    if (const InTriangle inside = in_triangle(triangle, point); inside.depth >= 0)
        return inside.uv;
    constexpr glm::dvec2 kCorners[] = {{0, 0}, {1, 0}, {0, 1}};
    glm::dvec2 best(0);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const glm::dvec2 edge = triangle.corners[j] - triangle.corners[i], way = point - triangle.corners[i];
        const double squared = glm::dot(edge, edge);
        const double along = squared > 0 ? std::clamp(glm::dot(way, edge) / squared, 0.0, 1.0) : 0.0;
        const double distance = glm::length(way - along * edge);
        if (distance < least) {
            least = distance;
            best = kCorners[i] * (1 - along) + kCorners[j] * along;
        }
    }
    return best;
}

} // namespace prt
