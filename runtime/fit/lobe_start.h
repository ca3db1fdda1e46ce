#pragma once

// Start values for the fit of a vertex's lobes.

#include "prt/fit/lobe_fit.h"

#include <glm/vec3.hpp>

namespace prt {

/// A lobe in double precision.
struct FreeLobe {
    glm::dvec3 axis{0, 0, 1};
    std::array<double, kMaxLobeOrder> profile{};
};

/// Writes start values to `lobes`, one lobe after another. Each removes the largest part of the residual of
/// the previous ones.
void start_lobes(int order, std::span<const double> target, const LobeFitOptions& options,
                 std::span<FreeLobe> lobes);

} // namespace prt
