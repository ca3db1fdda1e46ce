#pragma once

// An analytic clear sky: A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999. Stable.

#include "prt/light.h"

#include <array>

namespace prt {

/// The sky without its sun, about +Y. Radiance is linear Rec. 709 in kcd/m² (the model's unit); scale it to
/// the exposure. Immutable, thread-safe.
class PreethamSky {
public:
    /// `turbidity` is 2 (clear) to 10 (haze), the range for which the model was fitted; values from 1.7 are
    /// accepted. `sun` is the unit direction to the sun, not below the horizon. Throws `Error` for other
    /// values.
    PreethamSky(double turbidity, const glm::dvec3& sun);

    /// Returns the radiance in unit direction `direction`; black below the horizon.
    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// Returns the luminance of the zenith in kcd/m².
    double zenith_luminance() const { return zenith_luminance_; }

private:
    /// The five parameters of the distribution of Perez et al. (1993), fitted as in the paper's appendix A.2.
    using Perez = std::array<double, 5>;

    glm::dvec3 sun_;
    Perez luminance_, x_, y_;
    double zenith_luminance_; ///< kcd/m²
    /// Luminance and CIE chromaticity of the zenith, divided by the values of the distributions at the
    /// zenith.
    double luminance_over_perez_, x_over_perez_, y_over_perez_;
};

/// Projects the sky into SH by quadrature over the upper hemisphere, because the model has no closed form.
/// Add `directional_light` or `cone_light` for the sun, and a light from below for the ground.
Light sky_light(int order, const PreethamSky& sky);

} // namespace prt
