// Evaluates SH vectors in directions.
#include "prt/core/sh.h"

#include <array>

namespace prt {
namespace {

template <class Real, class Direction>
Real value(int order, std::span<const Real> function, const Direction& direction) {
    std::array<Real, kMaxOrder * kMaxOrder> basis;
    evaluate_sh(order, direction, std::span<Real>(basis));
    return sh_dot(function, std::span<const Real>(basis).first(function.size()));
}

} // namespace

float sh_value(int order, std::span<const float> function, const glm::vec3& direction) {
    return value(order, function, direction);
}

double sh_value(int order, std::span<const double> function, const glm::dvec3& direction) {
    return value(order, function, direction);
}

} // namespace prt
