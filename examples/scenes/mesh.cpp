// Builds and joins meshes.

#include "mesh.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace examples {

Mesh parametric_surface(int columns, int rows, const std::function<glm::vec3(float, float)>& surface) {
    Mesh mesh;
    constexpr float kStep = 1e-3f;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            const glm::vec3 along_u = surface(u + kStep, v) - surface(u - kStep, v);
            const glm::vec3 along_v = surface(u, v + kStep) - surface(u, v - kStep);
            mesh.positions.push_back(surface(u, v));
            mesh.normals.push_back(glm::normalize(glm::cross(along_u, along_v)));
            mesh.texcoords.emplace_back(u, 1 - v);
        }
    }
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row)
        for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(columns); ++column) {
            const std::uint32_t a = row * stride + column, b = a + 1, c = b + stride, d = a + stride;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

Mesh rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v, float spacing) {
    const auto cells = [&](const glm::vec3& edge) {
        return std::max(1, static_cast<int>(std::lround(glm::length(edge) / spacing)));
    };
    const auto surface = [&](float u, float v) { return corner + u * edge_u + v * edge_v; };
    return with_scaled_texcoords(parametric_surface(cells(edge_u), cells(edge_v), surface),
                                 {glm::length(edge_u), glm::length(edge_v)});
}

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.texcoords.insert(mesh.texcoords.end(), other.texcoords.begin(), other.texcoords.end());
    for (const std::uint32_t index : other.indices)
        mesh.indices.push_back(first + index);
}

Mesh placed(Mesh mesh, const glm::mat4& transform) {
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(transform * glm::vec4(position, 1));
    for (glm::vec3& normal : mesh.normals)
        normal = glm::mat3(transform) * normal;
    return mesh;
}

glm::mat4 placement(const glm::vec3& origin, float degrees) {
    return glm::rotate(glm::translate(glm::mat4(1), origin), degrees * kTurn / 360, glm::vec3(0, 1, 0));
}

Mesh with_scaled_texcoords(Mesh mesh, const glm::vec2& factor) {
    for (glm::vec2& texcoord : mesh.texcoords)
        texcoord *= factor;
    return mesh;
}

} // namespace examples
