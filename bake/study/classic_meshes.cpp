// Makes meshes of as many vertices as those of S. Hill's table of 2004, for `prt bench --classic`.

#include "prt/classic_meshes.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace prt {
namespace {

glm::vec3 bumpy_torus(double u, double v) {
    const double bump = 0.4 * (1 + 0.25 * std::cos(7 * u) * std::cos(5 * v));
    const double ring = 1 + bump * std::cos(v);
    return glm::vec3(ring * std::sin(u), bump * std::sin(v), ring * std::cos(u));
}

/// A closed grid of columns x rows vertices.
Scene torus(int columns, int rows) {
    Scene scene;
    scene.materials.emplace_back();
    VertexArray vertices;
    const double du = 2 * std::numbers::pi / columns, dv = 2 * std::numbers::pi / rows;
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            const double u = i * du, v = j * dv, h = 1e-3;
            vertices.positions.push_back(bumpy_torus(u, v));
            vertices.normals.push_back(
                glm::normalize(glm::cross(bumpy_torus(u + h, v) - bumpy_torus(u - h, v),
                                          bumpy_torus(u, v + h) - bumpy_torus(u, v - h))));
        }
    Primitive primitive;
    const auto at = [&](int i, int j) { return static_cast<unsigned>(i % columns * rows + j % rows); };
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            primitive.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            primitive.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    scene.vertex_arrays.push_back(std::move(vertices));
    scene.primitives.push_back(std::move(primitive));
    return scene;
}

} // namespace

std::array<ClassicRow, 3> classic_rows() {
    return {ClassicRow{2814, 14.27, 1.36, torus(67, 42)}, ClassicRow{10596, 151.66, 3.52, torus(883, 12)},
            ClassicRow{31076, 581.95, 9.49, torus(457, 68)}};
}

} // namespace prt
