#pragma once

// Splits an environment into suns and a sky. A game renders sharp shadows for the suns, and relights the
// model with transfer under the sky. Stable.

#include "prt/environment.h"
#include "prt/sun.h"

#include <optional>
#include <vector>

namespace prt {

/// Maximum number of suns that are chosen automatically; each costs the renderer a shadow map.
inline constexpr int kMaxAutoSuns = 4;

/// Settings of `find_suns`.
struct SunOptions {
    int order = 6; ///< order of the lighting for the remainder
    /// Maximum number of suns, at least 0. Without a value: up to kMaxAutoSuns, each of which must reduce the
    /// error by at least a hundredth of the light (docs/math.md, "Suns in an image").
    std::optional<int> count = {};
    int threads = 0;
};

/// An environment, split into suns and the remainder.
struct SunSplit {
    std::vector<Sun> suns; ///< sorted by luminance, strongest first
    /// [suns] luminance of each sun as a fraction of the total over all directions of the image.
    std::vector<double> energy_shares;
    Environment remainder;      ///< the image without the suns, not negative, with the same layout and size
    double remainder_share = 1; ///< luminance of the remainder as a fraction of the whole image's
    /// Relative error of the light of shadowed receivers at `order`, root mean square: with the whole image
    /// in the coefficients, and with separate suns.
    double error_without = 0, error_with = 0;
};

/// Finds suns in the pixels of `environment`: spots brighter than their surroundings that are too narrow for
/// `order` bands, with a half angle of at most `widest_sun(order)`. The texels of a sun are reduced to the
/// radiance of the surrounding sky, and the difference becomes the light of the sun. In band 0, suns and
/// remainder therefore sum to the original. A disc of three texels or more is measured to a fraction of a
/// texel (Ceres); a narrower one gets the size of its bright texels. Throws `Error` for an order outside
/// 1..kMaxOrder, a negative count, an invalid image, pixels that are negative or not finite, and light above
/// kMaxLight.
SunSplit find_suns(const Environment& environment, const SunOptions& options = {});

/// Returns the maximum half angle of a sun for `find_suns`, in radians: a quarter of pi / order, at most
/// 0.26.
double widest_sun(int order);

} // namespace prt
