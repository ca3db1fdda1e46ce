#pragma once

// Sun and sky apart: a game casts a sharp shadow from the sun and relights the rest with transfer. Stable.

#include "prt/environment.h"
#include "prt/sun_disc.h"

#include <optional>
#include <vector>

namespace prt {

/// How many suns `auto` takes at most: each costs a renderer a shadow map.
inline constexpr int kMostPayingSuns = 4;

struct SunOptions {
    int order = 6; ///< of the lighting that the rest becomes
    /// How many suns to find, at least 0; fewer are found where there are no more. Unset: of up to
    /// kMostPayingSuns as many as pay, each by lowering the error by a hundredth of the light
    /// (docs/math.md, "Suns in an image").
    std::optional<int> count = {};
    int threads = 0;
};

/// An environment taken apart into suns and the rest.
struct SunSplit {
    std::vector<SunDisc> suns; ///< by luminance, the strongest first
    Environment remainder;     ///< the image without them, nowhere below zero, of the same shape
    double remainder_share = 1;
    /// Errors of the light of shadowed receivers at `order`, over that light, root mean square: with all of
    /// the image in the coefficients, and with the suns lit apart.
    double error_without = 0, error_with = 0;
};

/// Finds suns in the pixels of `environment`: what stands out of its surroundings and is too narrow for
/// `order` bands, a half angle of at most `widest_sun(order)`. The texels of a sun are lowered to the sky
/// around it, and their light is the sun's: in band 0 suns and remainder add up to the whole. A disc that
/// spans three texels or more is measured to a fraction of a texel (Ceres), a narrower one is given the
/// extent of the texels that it lights. Throws `Error` for an order outside 1..kMaxOrder, a negative count,
/// an image that is none, pixels that are negative or not finite, and light beyond what is computed with.
SunSplit find_suns(const Environment& environment, const SunOptions& options = {});

/// The widest half angle, in radians, that `find_suns` takes for a sun's: a quarter of pi / order, at most
/// 0.26.
double widest_sun(int order);

} // namespace prt
