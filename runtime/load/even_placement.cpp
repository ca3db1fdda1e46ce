// Decomposes node matrices into rotation and uniform scale.
#include "runtime/load/even_placement.h"

#include <glm/matrix.hpp>

#include <cmath>

namespace prt {

std::optional<EvenPlacement> even_placement(const glm::dmat4& world) {
    constexpr double kRounding = 1e-5; // per element, relative to the scale: matrices in files are float
    const glm::dmat3 linear(world);
    const double determinant = glm::determinant(linear);
    if (!(determinant > 0))
        return std::nullopt;
    const double scale = std::cbrt(determinant);
    const glm::dmat3 rotation = linear / scale, square = glm::transpose(rotation) * rotation;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(square[i][j] - (i == j ? 1.0 : 0.0)) < kRounding))
                return std::nullopt;
    return EvenPlacement{rotation, scale};
}

} // namespace prt
