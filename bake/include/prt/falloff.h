#pragma once

// How far away surfaces still block. Experimental.

#include <limits>
#include <vector>

namespace prt {

/// What passes a surface that a ray meets, by its distance: obscurance (S. Zhukov, A. Iones and G. Kronin,
/// "An Ambient Light Illumination Model", 1998) with exponential terms, 1 - exp(log(1/2) x / d) each. What is
/// far away then darkens less, and the inside of closed rooms is not black.
struct Falloff {
    struct Term {
        double half_distance; ///< metres at which half passes
        double share = 1;     ///< of all terms
    };
    std::vector<Term> terms;                                   ///< empty: nothing passes
    double farthest = std::numeric_limits<double>::infinity(); ///< metres; beyond it everything passes

    /// Surfaces block at any distance.
    bool blocks_everywhere() const;
    double passes(double distance) const;
};

/// Throws `Error` for distances and shares that are none.
void check_falloff(const Falloff& falloff);

} // namespace prt
