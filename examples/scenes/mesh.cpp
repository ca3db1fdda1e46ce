#include "mesh.h"

#include <glm/geometric.hpp>

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
    return parametric_surface(cells(edge_u), cells(edge_v),
                              [&](float u, float v) { return corner + u * edge_u + v * edge_v; });
}

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    for (const std::uint32_t index : other.indices)
        mesh.indices.push_back(first + index);
}

} // namespace examples
