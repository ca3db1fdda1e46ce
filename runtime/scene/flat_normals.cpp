// Normals of triangles for vertices that have none.
#include "flat_normals.h"

#include "triangle_normal.h"

#include <array>
#include <map>
#include <utility>

namespace prt {
namespace {

glm::dvec3 area_normal_of(const VertexArray& vertices, const glm::uvec3& t) {
    return area_normal(vertices.positions[t.x], vertices.positions[t.y], vertices.positions[t.z]);
}

template <class T>
std::vector<T> gathered(const std::vector<T>& values, const std::vector<std::uint32_t>& source) {
    std::vector<T> result;
    if (values.empty())
        return result;
    result.reserve(source.size());
    for (const std::uint32_t i : source)
        result.push_back(values[i]);
    return result;
}

} // namespace

void split_for_flat_normals(VertexArray& vertices, std::vector<glm::uvec3>& triangles) {
    std::map<std::pair<std::uint32_t, std::array<float, 3>>, std::uint32_t> corners; // vertex and normal
    std::vector<std::uint32_t> source;
    std::vector<glm::vec3> normals;
    for (glm::uvec3& triangle : triangles) {
        const glm::vec3 normal = unit_or_zero(area_normal_of(vertices, triangle));
        for (int corner = 0; corner < 3; ++corner) {
            const auto key = std::pair(triangle[corner], std::array{normal.x, normal.y, normal.z});
            const auto [found, is_new] = corners.try_emplace(key, static_cast<std::uint32_t>(source.size()));
            if (is_new) {
                source.push_back(triangle[corner]);
                normals.push_back(normal);
            }
            triangle[corner] = found->second;
        }
    }
    vertices.positions = gathered(vertices.positions, source);
    vertices.colors = gathered(vertices.colors, source);
    for (auto& set : vertices.texcoords)
        set = gathered(set, source);
    vertices.normals = std::move(normals);
    vertices.source = std::move(source);
}

std::size_t replace_zero_normals(const Scene& scene, VertexArray& vertices) {
    std::vector<std::uint32_t> zero;
    for (std::uint32_t i = 0; i < vertices.size(); ++i)
        if (vertices.normals[i] == glm::vec3(0))
            zero.push_back(i);
    if (zero.empty())
        return 0;
    std::vector<glm::dvec3> sums(vertices.size(), glm::dvec3(0));
    for (const Primitive& primitive : scene.primitives) {
        if (&scene.vertex_arrays[primitive.vertices] != &vertices)
            continue;
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                sums[t[corner]] += area_normal_of(vertices, t);
    }
    std::size_t replaced = 0;
    for (const std::uint32_t i : zero) {
        vertices.normals[i] = unit_or_zero(sums[i]);
        replaced += vertices.normals[i] != glm::vec3(0);
    }
    return replaced;
}

} // namespace prt
