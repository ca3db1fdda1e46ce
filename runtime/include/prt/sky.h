#pragma once

// An analytic model of the clear daytime sky: A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic
// Model for Daylight", SIGGRAPH 1999. Stable.

#include "prt/light.h"

#include <array>

namespace prt {

/// The light of the sky without the disc of the sun. +Y is up. Radiance is linear Rec. 709 and scaled so that
/// its luminance is in kcd/m², the unit of the model; callers multiply it by their exposure. Immutable and
/// thread-safe.
class PreethamSky {
public:
    /// `turbidity` measures the haze: 2 is a clear sky, 10 is hazy. The model was fitted for 2 to 10. `sun`
    /// is the unit direction to the sun. Throws `Error` unless turbidity is in 1.7..10, sun.y >= 0 and the
    /// length of `sun` is 1 within 0.001.
    PreethamSky(double turbidity, const glm::dvec3& sun);

    /// Returns the radiance from unit direction `direction`: linear Rec. 709, luminance in kcd/m². Channels
    /// that would be negative are 0. Returns black for direction.y <= 0. For 0 < direction.y < 0.01 the model
    /// uses 0.01 for the height above the horizon.
    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// Luminance of the sky in direction +Y, in kcd/m².
    double zenith_luminance() const { return zenith_luminance_; }

private:
    /// The five parameters A to E of the sky distribution of Perez et al. (1993), from the formulas of
    /// Preetham et al., appendix A.2.
    using Perez = std::array<double, 5>;

    glm::dvec3 sun_;          ///< unit direction to the sun
    Perez luminance_, x_, y_; ///< distributions of the luminance and of the CIE chromaticities x and y
    double zenith_luminance_; ///< kcd/m²
    /// Luminance (kcd/m²) and CIE chromaticities x and y of the zenith, each divided by the value of its
    /// distribution at the zenith.
    double luminance_over_perez_, x_over_perez_, y_over_perez_;
};

/// Returns the radiance of `sky` as SH coefficients of `order` bands, in the unit of `PreethamSky::radiance`.
/// The result contains neither the sun nor light from the ground; callers can add both with `sum` of
/// prt/light.h, for example a `cone_light`. Throws `Error` for an order outside 1..kMaxOrder.
Light sky_light(int order, const PreethamSky& sky);

} // namespace prt
