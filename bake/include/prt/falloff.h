#pragma once

// Distance fall-off of occlusion: distant surfaces block less light. Experimental.

#include <limits>
#include <vector>

namespace prt {

/// Share of light that passes a surface hit by a ray, as a function of the distance: obscurance (S. Zhukov,
/// A. Iones and G. Kronin, "An Ambient Light Illumination Model", 1998) with exponential terms, 1 -
/// exp(log(1/2) x / d) each. With it, distant surfaces darken less, and the inside of closed rooms is not
/// black.
struct Falloff {
    struct Term {
        double half_distance; ///< distance in metres at which half of the light passes
        double share = 1;     ///< weight of this term; the sum is arbitrary
    };
    std::vector<Term> terms;                                   ///< empty: no light passes
    double farthest = std::numeric_limits<double>::infinity(); ///< metres; beyond it all light passes

    /// Returns whether surfaces block all light at every distance.
    bool blocks_everywhere() const;
    /// Returns the share of light that passes a surface at `distance` metres, 0..1.
    double passes(double distance) const;
};

/// Throws `Error` for invalid distances and shares.
void check_falloff(const Falloff& falloff);

} // namespace prt
