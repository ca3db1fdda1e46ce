// Computes the rotations nearest to the matrices of vertices (Higham, "Computing the polar decomposition",
// 1986, Newton's iteration).

#include "prt/bake/pose_bake.h"
#include "prt/core/sh_rotation.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace prt {
namespace {

double stretch_of(const glm::dmat3& m) {
    return std::sqrt((glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])) / 3);
}

/// Returns the rotation nearest to `matrix`, whose determinant is positive. A nearly singular matrix has no
/// unique rotation and gets the identity.
glm::dmat3 polar_rotation(const glm::dmat3& matrix) {
    const double size = stretch_of(matrix);
    if (!(size > 0) || !std::isfinite(size))
        return glm::dmat3(1);
    glm::dmat3 rotation = matrix / size;
    if (!(glm::determinant(rotation) > 1e-9))
        return glm::dmat3(1);
    for (int i = 0; i < 60; ++i) { // halves the logarithm of every stretch until it is about 1, then squares
        const glm::dmat3 next = 0.5 * (rotation + glm::transpose(glm::inverse(rotation)));
        const double change = stretch_of(next - rotation);
        rotation = next;
        if (change < 1e-12)
            break;
    }
    return rotation;
}

/// Applies w -> -w to a function: odd bands change their sign.
void mirror(int order, std::span<double> vector) {
    for (int l = 1; l < order; l += 2)
        for (int m = -l; m <= l; ++m)
            vector[static_cast<std::size_t>(sh_index(l, m))] *= -1;
}

} // namespace

VertexFrames::VertexFrames(const AnimatedScene& model, const ModelPose& pose) {
    for (std::size_t array = 0; array < model.vertices().size(); ++array) {
        const MovingVertices& moving = model.vertices()[array];
        const std::vector<glm::dmat4> palette = model.matrices(array, pose.nodes);
        for (std::size_t v = 0; v < moving.positions.size(); ++v) {
            const glm::dmat3 matrix(vertex_matrix(palette, moving, v));
            const bool mirrored = glm::determinant(matrix) < 0;
            matrices_.push_back(matrix);
            mirrored_.push_back(mirrored);
            rotations_.push_back(polar_rotation(mirrored ? -matrix : matrix));
        }
    }
}

void VertexFrames::to_world(int order, std::size_t vertex, std::span<const double> in,
                            std::span<double> out) const {
    ShRotation(order, rotations_[vertex]).apply(in, out);
    if (mirrored_[vertex])
        mirror(order, out);
}

void VertexFrames::from_world(int order, std::size_t vertex, std::span<const double> in,
                              std::span<double> out) const {
    ShRotation(order, glm::transpose(rotations_[vertex])).apply(in, out);
    if (mirrored_[vertex])
        mirror(order, out);
}

} // namespace prt
