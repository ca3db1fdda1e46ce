#pragma once

// Where the fit of a vertex's lobes begins.

#include "prt/lobe_fit.h"

#include <glm/vec3.hpp>

namespace prt {

/// A lobe in double.
struct FreeLobe {
    glm::dvec3 axis{0, 0, 1};
    std::array<double, kMostLobeOrder> profile{};
};

/// One lobe after the other, each where it takes most of what those before left: `lobes` are written.
void start_lobes(int order, std::span<const double> target, const LobeFitOptions& options,
                 std::span<FreeLobe> lobes);

} // namespace prt
