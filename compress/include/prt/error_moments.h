#pragma once

// The error of exit radiance under any lighting: second moments of transfer and of its errors. From these,
// `lit_rms` under a lighting takes microseconds, independent of the number of receivers. Experimental.

#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Sums over receivers p with area a_p. Exit radiance under L has the squared error L^T (sum a_p d_p d_p^T) L
/// and the square L^T (sum a_p T_p T_p^T) L, d_p = T_p - T'_p, for each color (docs/math.md, section 4).
struct ErrorMoments {
    TransferLayout layout;
    std::vector<double> errors, references; ///< [dimension][dimension] each, symmetric
};

/// Computes the moments by two passes of a symmetric rank-k update: dimension² operations per receiver, with
/// memory independent of the number of receivers. The result does not depend on `threads`. Throws `Error` if
/// layouts or numbers of receivers differ.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, int threads = 0);
/// Computes the moments with known `references`, which are equal for every approximation: half the work.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, std::vector<double> references, int threads = 0);
/// Computes `ErrorMoments::references`.
std::vector<double> second_moments(const TransferView& transfer, std::span<const float> areas,
                                   int threads = 0);

/// Returns `lit_rms` of prt/error_measures.h between the two transfers under `lighting`, up to rounding.
/// Returns 0 if neither radiates, infinity if only the error radiates. Throws `Error` if the lighting has
/// fewer bands than the layout.
double lit_rms(const ErrorMoments& moments, const LightingView& lighting);

/// Returns `expected_lit_rms` of prt/light_metric.h. Throws `Error` for a metric of another layout.
double expected_lit_rms(const ErrorMoments& moments, const LightMetric& metric);

/// `lit_rms` of one lighting, rotated as a whole about +Y; lamps are constant. Errors are relative to the
/// exit radiance at that angle, or to a tenth of its root mean square over all 3D rotations of the lighting
/// if that is larger. Otherwise the error would be infinite at angles without light (docs/math.md, section
/// 4).
struct LitRmsOverRotations {
    double mean = 0;        ///< root of the mean squared error over the mean square, over all angles: exact
    double worst = 0;       ///< at the worst angle
    double worst_angle = 0; ///< radians, as for `rotated_about_y`
};
/// Computes the errors over all angles. Squared errors and squares are trigonometric polynomials in the
/// angle, of degree 2(order - 1). They are determined from 4 order - 3 angles, evaluated at 32 order angles,
/// and refined near the maximum.
LitRmsOverRotations lit_rms_over_rotations(const ErrorMoments& moments, const Lighting& lighting);

} // namespace prt
