#pragma once

// Errors of a picture against path tracing (docs/math.md, section 11). Experimental.

#include "prt/flip.h"

#include <array>
#include <vector>

namespace prt {

/// Returns the mean of two pictures of equal size.
Image mean_of(const std::array<Image, 2>& halves);

/// Returns the expected relative L2 error, over `surfaces` [height][width], of the mean of two independent
/// unbiased pictures.
double noise_of(const std::array<Image, 2>& halves, const std::vector<bool>& surfaces);

/// Side in pixels of the blocks over which contrast errors are averaged.
inline constexpr int kContrastBlock = 8;

/// Error of a picture against a noisy reference. FLIP includes the noise. `relative_l2` and `contrast_rms`
/// exclude it, and `contrast_percentile_95` includes only 1/8 of it.
struct PictureError {
    double relative_l2 = 0;                       ///< over the pixels that show surfaces
    double flip_mean = 0, flip_percentile_95 = 0; ///< HDR-FLIP over all pixels
    /// Errors of luminance over Y + Y_a as in `VisibleError`, over the pixels that show surfaces: RMS, and
    /// the 95th percentile of the means over blocks of 8 x 8 pixels. The block means measure blotches and
    /// wrong levels rather than edges.
    double contrast_rms = 0, contrast_percentile_95 = 0;
    std::vector<float> flip; ///< [height][width]
};

/// Returns the relative L2 error of `picture` over `surfaces` [height][width]. The reference is the expected
/// value of `halves`, two independent unbiased pictures a and b: the mean of (p - a)(p - b) is the squared
/// error of p without noise. Returns 0 if that mean is negative.
double relative_l2(const Image& picture, const std::array<Image, 2>& halves,
                   const std::vector<bool>& surfaces);

/// Computes all errors; FLIP is against the mean of the halves. Throws `Error` if sizes differ or a value is
/// not finite.
PictureError picture_error(const Image& picture, const std::array<Image, 2>& halves,
                           const std::vector<bool>& surfaces, const FlipOptions& options = {});

} // namespace prt
