#pragma once

// Distance fall-off of occlusion: distant surfaces block less light. Experimental.

#include <limits>
#include <vector>

namespace prt {

/// Share of light that passes a surface hit by a ray, as a function of the distance: obscurance (S. Zhukov,
/// A. Iones and G. Kronin, "An Ambient Light Illumination Model", 1998). At distance x the share is the
/// weighted mean over `terms` of 1 - exp(log(1/2) x / d), with the half distance d of the term. With a
/// fall-off, distant surfaces darken less, and the inside of closed rooms is not black. The default blocks
/// all light at every distance.
struct Falloff {
    /// One exponential function of the distance.
    struct Term {
        double half_distance; ///< distance in metres at which half of the light passes; finite and greater
                              ///< than 0
        double share = 1;     ///< weight of this term relative to the sum of all weights; finite and at least
                              ///< 0, greater than 0 for at least one term
    };
    std::vector<Term> terms; ///< empty: no light passes up to distance `farthest`
    /// Distance in metres beyond which all light passes; greater than 0, may be infinite.
    double farthest = std::numeric_limits<double>::infinity();

    /// Returns whether surfaces block all light at every distance.
    bool blocks_everywhere() const;
    /// Returns the share of light that passes a surface at `distance` metres, 0..1.
    double passes(double distance) const;
};

/// Throws `Error` unless half distances are finite and greater than 0, shares are finite and at least 0, at
/// least one share is greater than 0 (if there are terms), and `farthest` is greater than 0.
void check_falloff(const Falloff& falloff);

} // namespace prt
