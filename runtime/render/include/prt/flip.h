#pragma once

// Perceptual difference of two pictures: FLIP (P. Andersson et al., "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020) and HDR-FLIP (the same authors, "Visualizing and Communicating Errors in
// Rendered Images", Ray Tracing Gems II, 2021). docs/math.md, section 11. Experimental.

#include "prt/environment.h"

#include <vector>

namespace prt {

/// Viewing conditions of FLIP.
struct FlipOptions {
    /// Pixels per degree of the field of view: 67 corresponds to a 4K monitor of 0.7 m width seen from 0.7 m.
    float pixels_per_degree = 67;
    int threads = 0; ///< 0: all
};

/// Computes FLIP of two linear pictures, whose values are clamped to 0..1. Returns per pixel a number from 0
/// (identical) to 1, [height][width]. Throws `Error` if sizes differ or a picture is empty.
std::vector<float> flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// Exposures of HDR-FLIP in stops: `count` equally spaced ones from `start` to `stop`. At `start` the
/// brightest pixel is mapped to 0.85 of the maximum of the tone curve, at `stop` the median luminance is.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;
};
/// Returns the exposures of HDR-FLIP for a reference picture.
FlipExposures flip_exposures(const Image& reference);

/// Computes HDR-FLIP of two linear pictures of any range: for each pixel the maximum FLIP over
/// `flip_exposures(reference)`, [height][width]. Negative values count as 0. Throws `Error` if sizes differ,
/// a picture is empty, or a value is not finite.
std::vector<float> hdr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

} // namespace prt
