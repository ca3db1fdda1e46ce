#pragma once

// Perceptual difference of two pictures: FLIP (P. Andersson et al., "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020) and HDR-FLIP (the same, "Visualizing and Communicating Errors in Rendered
// Images", Ray Tracing Gems II, 2021). docs/math.md, section 11. Experimental.

#include "prt/environment.h"

#include <vector>

namespace prt {

struct FlipOptions {
    /// Pixels per degree of the field of view: 67 corresponds to a 4K monitor of 0.7 m width seen from 0.7 m.
    float pixels_per_degree = 67;
    int threads = 0; ///< 0: all
};

/// Computes FLIP of linear pictures; values are clamped to 0..1. Returns 0 (identical) to 1 per pixel,
/// [height][width]. Throws `Error` if sizes differ or a picture is empty.
std::vector<float> flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// Exposure range of HDR-FLIP in stops: from the exposure that maps the brightest pixel, to the exposure that
/// maps the median luminance, to 0.85 of the maximum of the tone curve.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
FlipExposures flip_exposures(const Image& reference);

/// Computes HDR-FLIP of linear pictures of any range: the maximum FLIP of each pixel over the exposures of
/// `reference`. Negative values count as 0. Throws `Error` as `flip`, and if a value is not finite.
std::vector<float> hdr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

} // namespace prt
