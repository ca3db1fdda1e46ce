#pragma once

// Errors of a picture against path tracing (docs/math.md, section 11). Experimental.

#include "prt/flip.h"

#include <array>
#include <vector>

namespace prt {

/// Mean of two pictures of one size.
Image mean_of(const std::array<Image, 2>& halves);

/// Expected relative L2 of the mean of two independent unbiased pictures over `surfaces` [height][width].
double noise_of(const std::array<Image, 2>& halves, const std::vector<bool>& surfaces);

/// Side of the blocks of pixels over which contrast errors are means.
inline constexpr int kContrastBlock = 8;

/// Error of a picture against a reference with noise. The noise counts in FLIP; it does not in `relative_l2`
/// and `contrast_rms`, and only a 1/8 of it does in `contrast_percentile_95`.
struct PictureError {
    double relative_l2 = 0;                       ///< over the pixels that show surfaces
    double flip_mean = 0, flip_percentile_95 = 0; ///< HDR-FLIP over all pixels
    /// Errors of luminance over Y + Y_a as in `VisibleError`, of the pixels that show surfaces: RMS, and 95th
    /// percentile of the means over blocks of 8 x 8 pixels, which are blotches and wrong levels and not
    /// edges.
    double contrast_rms = 0, contrast_percentile_95 = 0;
    std::vector<float> flip; ///< [height][width]
};

/// Relative L2 of `picture` over `surfaces` [height][width] against the value that `halves`, two independent
/// unbiased pictures, are estimates of: the mean of (p - a)(p - b) is the squared error of p without noise.
/// 0 where that is negative.
double relative_l2(const Image& picture, const std::array<Image, 2>& halves,
                   const std::vector<bool>& surfaces);

/// All of it; FLIP is against the mean of the halves. Throws `Error` where sizes differ and where a value is
/// not finite.
PictureError picture_error(const Image& picture, const std::array<Image, 2>& halves,
                           const std::vector<bool>& surfaces, const FlipOptions& options = {});

} // namespace prt
