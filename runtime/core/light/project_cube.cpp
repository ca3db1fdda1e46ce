// Projects the faces of a cube.

#include "runtime/core/light/square_sums.h"
#include "runtime/core/sh/gauss_legendre.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace prt {
namespace {

/// Returns the part of a texel's cell on the face; border texels are centered on the border.
Cell centerd_cell(int size, int i) {
    if (size == 1)
        return {-1, 1};
    const double half = 1.0 / (size - 1), center = 2.0 * i / (size - 1) - 1;
    return {std::max(-1.0, center - half), std::min(1.0, center + half)};
}

/// Returns the node at (s, t) of a cube face, at distance sqrt(1 + s² + t²).
Node on_face(double s, double t, double area) {
    const double inverse = 1 / std::sqrt(1 + s * s + t * t);
    return {{s * inverse, t * inverse, inverse}, area * inverse * inverse * inverse};
}

} // namespace

int points_for(double angle) {
    return angle > 0.2 ? 24 : angle > 0.04 ? 3 : 2;
}

ProjectedColors project_cube(const Environment& environment, int order, int threads) {
    const int size = environment.image.width;
    const bool exr = environment.layout == EnvironmentLayout::cube;
    const GaussLegendre quadrature(points_for(2.0 / size));
    const std::size_t n = quadrature.nodes.size();
    const auto cell = [&](int i) { return exr ? centerd_cell(size, i) : even_cell(size, i); };
    const auto put_row = [&](int y, RowOfTexels& row) {
        const Cell v = cell(y);
        for (std::size_t x = 0; x < row.count; ++x) {
            const Cell u = cell(static_cast<int>(x));
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i)
                    row.put(x, j * n + i,
                            on_face(u.at(quadrature.nodes[i]), v.at(quadrature.nodes[j]),
                                    u.half() * v.half() * quadrature.weights[i] * quadrature.weights[j]));
        }
    };
    const auto fold_row = [&](int face, int y, std::size_t stride, float* parts) {
        const Image& image = environment.image;
        fold(&image.at(0, face * size + y), &image.at(0, face * size + size - 1 - y), size, y, stride, parts);
    };
    const auto faces = project_squares(size, 6, n * n, order, threads, put_row, fold_row);
    ProjectedColors result{};
    for (int face = 0; face < 6; ++face) {
        const auto at = [&](double u, double v) {
            return exr ? cube_direction(face, u, v) : cube_face_direction(face, u, v);
        };
        const glm::dvec3 outward = at(0, 0), right = std::sqrt(2.0) * at(1, 0) - outward,
                         down = std::sqrt(2.0) * at(0, 1) - outward;
        add_square(faces[static_cast<std::size_t>(face)], right, down, outward, order, result);
    }
    return result;
}

} // namespace prt
