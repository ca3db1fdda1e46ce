#pragma once

// Reaches a target error with the same number of rays for all receivers, where the number cannot differ
// between them.

#include "prt/bake/bake_options.h"

#include <string>

namespace prt {

struct EqualRays {
    int rays = 0;     ///< rays per receiver
    double error = 0; ///< measured relative L2 error
    bool reached = false;
};

/// Doubles the number of rays until `error_with(rays)` is at most `target`, up to kMaxRays. All calls but the
/// last together trace fewer rays than the last.
template <class Measure>
EqualRays equal_rays(double target, Measure&& error_with) {
    constexpr int kFirst = 64; // fewer rays give no reliable estimate
    static_assert(kMaxRays % kFirst == 0);
    for (int rays = kFirst;; rays *= 2) {
        const double error = error_with(rays);
        if (error <= target || rays == kMaxRays)
            return {rays, error, error <= target};
    }
}

/// Returns the notice for a target error that kMaxRays rays per receiver do not reach.
inline std::string missed_target() {
    return "the target error was not reached with " + std::to_string(kMaxRays) + " rays per receiver";
}

} // namespace prt
