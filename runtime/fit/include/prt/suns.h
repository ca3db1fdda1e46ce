#pragma once

// Splits an environment into suns and a sky: a game renders sharp shadows for the suns and relights the rest
// with transfer. Stable.

#include "prt/environment.h"
#include "prt/sun.h"

#include <optional>
#include <vector>

namespace prt {

/// Maximum number of suns that are chosen automatically; each costs the renderer a shadow map.
inline constexpr int kMaxAutoSuns = 4;

struct SunOptions {
    int order = 6; ///< order of the lighting for the remainder
    /// Number of suns to find, at least 0; fewer are found if the image has fewer. Without a value: suns are
    /// added, up to kMaxAutoSuns, if each lowers the error by at least a hundredth of the light
    /// (docs/math.md, "Suns in an image").
    std::optional<int> count = {};
    int threads = 0;
};

/// An environment, split into suns and the remainder.
struct SunSplit {
    std::vector<Sun> suns; ///< sorted by luminance, strongest first
    /// [suns] luminance of each sun as a fraction of the total over all directions of the image.
    std::vector<double> energy_shares;
    Environment remainder; ///< the image without the suns, not negative, with the same layout and size
    double remainder_share = 1;
    /// Relative error of the light of shadowed receivers at `order`, root mean square: with the whole image
    /// in the coefficients, and with separate suns.
    double error_without = 0, error_with = 0;
};

/// Finds suns in the pixels of `environment`: spots brighter than their surroundings that are too narrow for
/// `order` bands, with a half angle of at most `widest_sun(order)`. The texels of a sun are lowered to the
/// surrounding sky, and the difference becomes the light of the sun: in band 0 suns and remainder sum to the
/// original. A disc of three texels or more is measured to a fraction of a texel (Ceres); a narrower one gets
/// the size of its bright texels. Throws `Error` for an order outside 1..kMaxOrder, a negative count, an
/// invalid image, pixels that are negative or not finite, and light above kMaxLight.
SunSplit find_suns(const Environment& environment, const SunOptions& options = {});

/// Returns the maximum half angle of a sun for `find_suns`, in radians: a quarter of pi / order, at most
/// 0.26.
double widest_sun(int order);

} // namespace prt
