#pragma once

// Errors of a picture against a path-traced reference (docs/math.md, section 11). The reference consists of
// two halves: independent, unbiased pictures with noise. Experimental.

#include "runtime/render/flip.h"

#include <array>
#include <vector>

namespace prt {

/// Returns the mean of two pictures, pixel by pixel. Throws `Error` if their numbers of pixels differ.
Image mean_of(const std::array<Image, 2>& halves);

/// Returns an estimate of the relative L2 error that noise causes in mean_of(halves): the root of the
/// expected squared error of RGB over the squared reference, a fraction. Uses only the pixels for which
/// `surfaces` [height][width] is true. `halves`: two independent, unbiased pictures of the same view, linear
/// Rec. 709. Returns 0 if the sum of the products of the halves over these pixels is not positive, for
/// example if all are black. Throws `Error` if the halves and `surfaces` have different numbers of pixels.
double noise_of(const std::array<Image, 2>& halves, const std::vector<bool>& surfaces);

/// Side in pixels of the square blocks over which `picture_error` averages luminance for contrast errors.
inline constexpr int kContrastBlock = 8;

/// Error of a picture against a noisy reference.
struct PictureError {
    /// Root of the squared error of RGB over the squared reference, over the pixels that show surfaces. Noise
    /// of the reference is excluded.
    double relative_l2 = 0;
    /// Mean and 95th percentile of `flip` over all pixels, including the background, 0..1. Noise of the
    /// reference is included.
    double flip_mean = 0, flip_percentile_95 = 0;
    /// Contrast errors over the pixels that show surfaces: errors of luminance over Y + Y_a. Y is the mean
    /// luminance of the reference in a block of 8 x 8 pixels; Y_a is a tenth of the logarithmic mean of Y
    /// over these pixels (`VisibleError`). 0 if the surfaces are black.
    /// `contrast_rms`: root mean square over the pixels, without the noise of the reference.
    /// `contrast_percentile_95`: 95th percentile of the errors of the mean luminance of each block, weighted
    /// by the number of pixels. Measures blotches and wrong levels rather than edges. Includes about 1/8 of
    /// the noise of a pixel.
    double contrast_rms = 0, contrast_percentile_95 = 0;
    std::vector<float> flip; ///< [height][width] HDR-FLIP against the mean of the halves, 0..1
};

/// Returns the relative L2 error of `picture` without the noise of the reference: the root of the squared
/// error of RGB over the squared reference. Uses only the pixels for which `surfaces` [height][width] is
/// true. `halves`: two independent, unbiased pictures a and b, whose expected value is the reference. All
/// pictures must have the size of `surfaces`. For a pixel p of `picture`, the mean of (p - a)(p - b)
/// estimates the squared error. Returns 0 if this estimate or the squared reference is not positive.
double relative_l2(const Image& picture, const std::array<Image, 2>& halves,
                   const std::vector<bool>& surfaces);

/// Computes all errors of `picture` against the reference `halves`: two independent, unbiased pictures of
/// equal size. All pictures are linear Rec. 709. `surfaces`: [height][width], whether a pixel shows a surface
/// and not the background. `options`: for FLIP. Throws `Error` if the sizes of `picture`, `halves` and
/// `surfaces` differ, a picture is empty, or a value is not finite.
PictureError picture_error(const Image& picture, const std::array<Image, 2>& halves,
                           const std::vector<bool>& surfaces, const FlipOptions& options = {});

} // namespace prt
