#pragma once

// Lighting on a grid of directions that is fine enough to bound the values between them.

#include "prt/core/light.h"

#include <vector>

namespace prt {

/// A direction with a low value in some channel.
struct LowPoint {
    glm::vec3 direction;
    float value; ///< relative to the channel's mean
};

struct GridRadiance {
    double least, largest;        ///< over all channels on the grid, relative to their means
    std::vector<LowPoint> points; ///< the minimum of each patch of the grid, if negative

    double range() const { return largest - least; }
};

/// Returns the mean radiance of channel `c`; 0 if it is not positive, or less than a millionth of a
/// coefficient. Non-negative light has no such large coefficients (docs/math.md, eq. 2), and relative values
/// would be rounding error and overflow.
double usable_mean(const Light& light, int c);

/// Evaluates all channels with a usable mean in `rows` rings of 2 `rows` directions. `rows` is a multiple of
/// 16.
GridRadiance radiance_on_grid(const Light& light, int rows);

/// Returns the maximum difference between the minimum over the grid and the minimum over all directions,
/// relative to the grid's range (docs/math.md, eq. 18).
double share_between(int order, int rows);

/// Returns the minimum number of rows for which `share_between` is at most `share`.
int rows_for(int order, double share);

} // namespace prt
