#pragma once

// Lighting on a grid of directions that is so fine that it proves what lies between them.

#include "prt/light.h"

#include <vector>

namespace prt {

/// A direction where some channel is low.
struct LowPoint {
    glm::vec3 direction;
    float value; ///< as a share of the channel's mean
};

struct GridRadiance {
    double least, largest;        ///< of all channels on the grid, as shares of their means
    std::vector<LowPoint> points; ///< what is below 0, of each patch of the grid the lowest

    double range() const { return largest - least; }
};

/// The mean radiance of channel `c`; 0 where it is not positive, or less than a millionth of a coefficient:
/// light that is nowhere negative has none so far above it (docs/math.md, eq. 2), and shares of it would be
/// rounding and overflow.
double usable_mean(const Light& light, int c);

/// All channels with a usable mean in `rows` rings of 2 `rows` directions. `rows` is a multiple of 16.
GridRadiance radiance_on_grid(const Light& light, int rows);

/// How far the least radiance over all directions can be below that on a grid, as a share of the grid's
/// range (docs/math.md, eq. 18).
double share_between(int order, int rows);

/// The fewest rows for which that share is at most `share`.
int rows_for(int order, double share);

} // namespace prt
