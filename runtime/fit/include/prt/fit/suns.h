#pragma once

// Splits an environment into suns and a sky. A game renders sharp shadows for the suns, and relights the
// model with transfer under the sky. Stable.

#include "prt/core/environment.h"
#include "prt/core/light.h"

#include <optional>
#include <vector>

namespace prt {

/// Maximum number of suns if `SunOptions::count` has no value; each sun costs the renderer a shadow map.
inline constexpr int kMaxAutoSuns = 4;

/// Settings of `find_suns`.
struct SunOptions {
    int order = 6; ///< number of SH bands into which the caller projects the remainder, 1..kMaxOrder
    /// Maximum number of suns, at least 0; fewer if the image has fewer. Without a value: the number in
    /// 0..kMaxAutoSuns for which `SunSplit::error_with` plus 0.01 per sun is smallest (docs/math.md, "Suns in
    /// an image").
    std::optional<int> count = {};
    int threads = 0; ///< 0: all
};

/// An environment, split into suns and the remainder.
struct SunSplit {
    std::vector<Sun> suns; ///< sorted by luminance, strongest first; may be empty
    /// [suns] luminance of each sun, integrated over its disc, as a fraction of the luminance of the whole
    /// image, integrated over all directions.
    std::vector<double> energy_shares;
    /// The image without the light of the suns, not negative; layout and size are those of the input.
    Environment remainder;
    double remainder_share = 1; ///< 1 minus the sum of `energy_shares`
    /// Relative L2 errors of the exit radiance of partially shadowed receivers (docs/math.md, "Suns in an
    /// image"), against the exact light of the image. `error_without`: the whole image is SH of `order`
    /// bands. `error_with`: the remainder is SH of `order` bands, and the suns are exact; equals
    /// `error_without` if there are no suns.
    double error_without = 0, error_with = 0;
};

/// Finds suns in the pixels of `environment`: roughly round spots that are brighter than their surroundings
/// and too narrow for `order` bands, with an angular radius at half of their brightness of at most
/// `widest_sun(order)`. Reduces the texels of a sun to the radiance of the surrounding sky in
/// `SunSplit::remainder`; the difference becomes the light of the sun. In band 0, suns and remainder
/// therefore sum to the original. The size of a sun of about three texels or more is accurate to a fraction
/// of a texel; a smaller sun gets the solid angle of its bright texels. Throws `Error` for an order outside
/// 1..kMaxOrder, a negative count, an invalid image, pixels that are negative or not finite, and SH
/// coefficients of the image above kMaxLight.
SunSplit find_suns(const Environment& environment, const SunOptions& options = {});

/// Returns the maximum angular radius of a spot that `find_suns` accepts as a sun, in radians: pi / (4
/// order), but at most 0.26. The radius is measured at half of the spot's brightness; the fitted
/// Sun::half_angle can be larger. Throws `Error` for an order outside 1..kMaxOrder.
double widest_sun(int order);

} // namespace prt
