#pragma once

// Perceptual difference of two pictures: FLIP (P. Andersson et al., "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020) and HDR-FLIP (the same, "Visualizing and Communicating Errors in Rendered
// Images", Ray Tracing Gems II, 2021). docs/math.md, section 11. Experimental.

#include "prt/environment.h"

#include <vector>

namespace prt {

struct FlipOptions {
    /// Pixels per degree of the field of view: 67 is a 4K monitor of 0.7 m width seen from 0.7 m.
    float pixels_per_degree = 67;
    int threads = 0; ///< 0: all
};

/// FLIP of linear pictures in 0..1, values outside are clamped: 0 (the same) to 1 per pixel,
/// [height][width]. Throws `Error` where sizes differ or a picture is empty.
std::vector<float> flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// Exposures, in stops, between which HDR-FLIP looks: from the one that shows the brightest pixel to the one
/// that shows the median luminance, both at 0.85 of what the tone curve gives at most.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
FlipExposures flip_exposures(const Image& reference);

/// HDR-FLIP of linear pictures of any range: the greatest FLIP of each pixel over these exposures of
/// `reference`. Negative values count as 0. Throws `Error` also where a value is not finite.
std::vector<float> hdr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

} // namespace prt
