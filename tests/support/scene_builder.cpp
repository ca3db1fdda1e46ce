// Builds scenes of simple shapes.

#include "scene_builder.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::test {
namespace {

glm::vec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 n = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    return glm::length(n) > 0 ? glm::vec3(glm::normalize(n)) : glm::vec3(0, 1, 0);
}

} // namespace

std::uint32_t SceneBuilder::vertex(const glm::vec3& position, const glm::vec3& normal) {
    vertices_.positions.push_back(position);
    vertices_.normals.push_back(normal);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
}

SceneBuilder& SceneBuilder::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 n = face_normal(a, b, c);
    const std::uint32_t first = vertex(a, n);
    vertex(b, n);
    vertex(c, n);
    triangles_.emplace_back(first, first + 1, first + 2);
    return *this;
}

SceneBuilder& SceneBuilder::quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                                 const glm::vec3& d) {
    return triangle(a, b, c).triangle(a, c, d);
}

SceneBuilder& SceneBuilder::disc(const glm::vec3& centre, const glm::vec3& axis, float radius, int segments) {
    const glm::vec3 side =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 other = glm::cross(axis, side);
    const auto rim = [&](int i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        return centre + radius * (side * static_cast<float>(std::cos(angle)) +
                                  other * static_cast<float>(std::sin(angle)));
    };
    for (int i = 0; i < segments; ++i)
        triangle(centre, rim(i), rim(i + 1));
    return *this;
}

SceneBuilder& SceneBuilder::sphere(const glm::vec3& centre, float radius, int rows) {
    const auto first = static_cast<std::uint32_t>(vertices_.size());
    const auto columns = static_cast<std::uint32_t>(2 * rows);
    for (int row = 0; row <= rows; ++row)
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double theta = std::numbers::pi * row / rows, phi = 2 * std::numbers::pi * column / columns;
            const glm::vec3 n(std::sin(theta) * std::sin(phi), std::cos(theta),
                              std::sin(theta) * std::cos(phi));
            vertex(centre + radius * n, n);
        }
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = first + row * (columns + 1) + column, b = a + columns + 1;
            triangles_.emplace_back(a, b, b + 1);
            triangles_.emplace_back(a, b + 1, a + 1);
        }
    return *this;
}

SceneBuilder& SceneBuilder::bowl(const glm::vec3& centre, float radius, int rows, int open_rows) {
    const std::size_t first_vertex = vertices_.size(), first_triangle = triangles_.size();
    sphere(centre, radius, rows);
    for (std::size_t v = first_vertex; v < vertices_.size(); ++v)
        vertices_.normals[v] = -vertices_.normals[v];
    const auto open = static_cast<std::ptrdiff_t>(first_triangle) + 4 * rows * open_rows;
    triangles_.erase(triangles_.begin() + static_cast<std::ptrdiff_t>(first_triangle),
                     triangles_.begin() + open);
    for (std::size_t t = first_triangle; t < triangles_.size(); ++t)
        std::swap(triangles_[t].y, triangles_[t].z);
    return *this;
}

SceneBuilder& SceneBuilder::floor(const glm::vec3& centre, float half_size, int cells) {
    const auto at = [&](int i, int j) {
        const auto t = [&](int k) {
            return half_size * (2 * static_cast<float>(k) / static_cast<float>(cells) - 1);
        };
        return centre + glm::vec3(t(i), 0, -t(j));
    };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i)
            quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return *this;
}

SceneBuilder& SceneBuilder::transform(const std::function<glm::vec3(const glm::vec3&)>& change) {
    for (glm::vec3& position : vertices_.positions)
        position = change(position);
    return *this;
}

Scene SceneBuilder::build() const {
    Scene scene;
    scene.vertex_arrays.push_back(vertices_);
    scene.materials.emplace_back();
    Primitive primitive;
    primitive.triangles = triangles_;
    scene.primitives.push_back(primitive);
    return scene;
}

Scene join(const std::vector<Scene>& parts) {
    Scene scene;
    for (const Scene& part : parts) {
        const std::size_t vertices = scene.vertex_arrays.size(), materials = scene.materials.size();
        for (const VertexArray& array : part.vertex_arrays) {
            scene.vertex_arrays.push_back(array);
            scene.vertex_arrays.back().first_receiver = scene.receivers() - array.size();
        }
        for (Primitive primitive : part.primitives) {
            primitive.vertices += vertices;
            primitive.material += materials;
            primitive.node += static_cast<int>(vertices);
            scene.primitives.push_back(std::move(primitive));
        }
        scene.materials.insert(scene.materials.end(), part.materials.begin(), part.materials.end());
        scene.images.insert(scene.images.end(), part.images.begin(), part.images.end());
    }
    return scene;
}

Scene painted(Scene scene, const glm::vec3& color, bool double_sided) {
    for (Material& material : scene.materials) {
        material.base_color = glm::vec4(color, 1);
        material.double_sided = double_sided;
    }
    return scene;
}

Scene with_opposites(Scene scene) {
    std::vector<unsigned> first_back;
    for (VertexArray& vertices : scene.vertex_arrays) {
        first_back.push_back(static_cast<unsigned>(vertices.size()));
        vertices.first_receiver *= 2;
        const auto repeat = [](auto& values) {
            const auto fronts = values;
            values.insert(values.end(), fronts.begin(), fronts.end());
        };
        repeat(vertices.positions);
        repeat(vertices.colors);
        std::ranges::for_each(vertices.texcoords, repeat);
        for (std::size_t v = 0; v < first_back.back(); ++v)
            vertices.normals.push_back(-vertices.normals[v]);
    }
    for (Primitive& primitive : scene.primitives)
        for (std::size_t t = 0, count = primitive.triangles.size(); t < count; ++t) {
            const glm::uvec3 corners = primitive.triangles[t] + first_back[primitive.vertices];
            primitive.triangles.emplace_back(corners.x, corners.z, corners.y);
        }
    for (Material& material : scene.materials)
        material.double_sided = false;
    return scene;
}

PunctualLight lamp_at(const glm::vec3& position) {
    PunctualLight light;
    light.name = "lamp";
    light.position = position;
    return light;
}

} // namespace prt::test
