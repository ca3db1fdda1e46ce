#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// Luminance of a linear color by the weights of Rec. 709.
template <class Real>
Real luminance(const glm::vec<3, Real>& rgb) {
    return glm::dot(rgb, glm::vec<3, Real>(0.2126, 0.7152, 0.0722));
}

} // namespace prt
