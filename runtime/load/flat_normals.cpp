// Computes normals of triangles for vertices without normals.
#include "runtime/load/flat_normals.h"

#include "runtime/load/triangle_normal.h"

#include <algorithm>
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

std::size_t replace_zero_normals(Scene& scene) {
    const auto is_zero = [](const glm::vec3& normal) { return normal == glm::vec3(0); };
    std::vector<std::vector<glm::dvec3>> sums(scene.vertex_arrays.size()); // empty if no normal is zero
    for (std::size_t array = 0; array < sums.size(); ++array) {
        const std::vector<glm::vec3>& normals = scene.vertex_arrays[array].normals;
        if (std::any_of(normals.begin(), normals.end(), is_zero))
            sums[array].resize(normals.size(), glm::dvec3(0));
    }
    for (const Primitive& primitive : scene.primitives) {
        std::vector<glm::dvec3>& sum = sums[primitive.vertices];
        if (sum.empty())
            continue;
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                sum[t[corner]] += area_normal_of(scene.vertex_arrays[primitive.vertices], t);
    }
    std::size_t replaced = 0;
    for (std::size_t array = 0; array < sums.size(); ++array)
        for (std::size_t i = 0; i < sums[array].size(); ++i) {
            glm::vec3& normal = scene.vertex_arrays[array].normals[i];
            if (!is_zero(normal))
                continue;
            normal = unit_or_zero(sums[array][i]);
            replaced += !is_zero(normal);
        }
    return replaced;
}

} // namespace prt
