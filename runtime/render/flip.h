#pragma once

// Measures the visible difference of two pictures: FLIP (P. Andersson et al., "FLIP: A Difference Evaluator
// for Alternating Images", HPG 2020) and HDR-FLIP (the same authors, "Visualizing and Communicating Errors in
// Rendered Images", Ray Tracing Gems II, 2021). docs/math.md, section 11. Experimental.

#include "prt/core/environment.h"

#include <vector>

namespace prt {

/// Viewing conditions and threads for FLIP.
struct FlipOptions {
    /// Number of pixels of the displayed picture per degree of the viewer's field of view. The default is
    /// that of a 4K monitor of 0.7 m width at a distance of 0.7 m.
    float pixels_per_degree = 67;
    int threads = 0; ///< number of CPU threads; 0: all
};

/// Computes FLIP of two pictures in linear Rec. 709; clamps the values of the pictures to 0..1 before.
/// Returns the difference at each pixel, [height][width], from 0 (identical) to 1. Throws `Error` if sizes
/// differ or a picture is empty.
std::vector<float> flip(const Image& reference, const Image& test, const FlipOptions& options = {});

/// Exposures of HDR-FLIP: `count` equally spaced values from `start` to `stop`, both included. An exposure of
/// s stops multiplies radiance by 2^s before the tone curve, whose maximum is 1.
struct FlipExposures {
    /// Exposures in stops; `stop` is `start` or more. The tone curve maps the largest luminance of the
    /// reference to 0.85 at `start`, and its median luminance to 0.85 at `stop`.
    double start = 0, stop = 0;
    int count = 2; ///< number of exposures: `stop` - `start`, rounded up, at least 2
};
/// Returns the exposures of HDR-FLIP for a reference picture in linear Rec. 709. A median below 2^-20 of the
/// largest luminance counts as 2^-20 of it. Returns the defaults if the picture is black or empty.
FlipExposures flip_exposures(const Image& reference);

/// Computes HDR-FLIP of two pictures in linear Rec. 709 with values of any range; negative values count as 0.
/// Returns for each pixel, [height][width], the maximum of FLIP over the exposures
/// `flip_exposures(reference)`, from 0 (identical) to 1. Throws `Error` if sizes differ, a picture is empty,
/// or a value is not finite.
std::vector<float> hdr_flip(const Image& reference, const Image& test, const FlipOptions& options = {});

} // namespace prt
