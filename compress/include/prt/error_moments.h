#pragma once

// Second moments of transfer and of its errors. From them, the `lit_rms` under any lighting is computed in
// microseconds, independent of the number of receivers. Experimental.

#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments, summed over receivers p with area a_p: `errors` = sum a_p d_p d_p^T with d_p = T_p - T'_p,
/// and `references` = sum a_p T_p T_p^T. For each color, exit radiance under lighting L has the squared error
/// L^T errors L and the square L^T references L (docs/math.md, section 4).
struct ErrorMoments {
    TransferLayout layout;
    std::vector<double> errors, references; ///< [dimension][dimension] each, symmetric
};

/// Computes the moments by symmetric rank-k updates: dimension² operations per receiver, and memory that does
/// not depend on the number of receivers. The result does not depend on `threads`. Throws `Error` if layouts
/// or numbers of receivers differ.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, int threads = 0);
/// Computes the moments for known `references`, which are the same for every approximation. This halves the
/// work.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, std::vector<double> references, int threads = 0);
/// Computes `ErrorMoments::references` of `transfer`.
std::vector<double> second_moments(const TransferView& transfer, std::span<const float> areas,
                                   int threads = 0);

/// Returns the `lit_rms` of prt/error_measures.h under `lighting`, up to rounding. Returns 0 if both
/// transfers are black, and infinity if only the reference is. Throws `Error` if the lighting has fewer bands
/// than the layout.
double lit_rms(const ErrorMoments& moments, const LightingView& lighting);

/// Returns the `expected_lit_rms` of prt/light_metric.h under `metric`. Throws `Error` for a metric of
/// another layout.
double expected_lit_rms(const ErrorMoments& moments, const LightMetric& metric);

/// The `lit_rms` under one lighting at all its rotations about +Y; lamps do not rotate. Errors are relative
/// to the exit radiance at that angle, or to a tenth of its root mean square over all 3D rotations if that is
/// larger. Without this limit the error would be infinite at angles without light (docs/math.md, section 4).
struct LitRmsOverRotations {
    /// Root of the mean squared error divided by the mean square, both over all angles; exact.
    double mean = 0;
    double worst = 0;       ///< at the worst angle
    double worst_angle = 0; ///< radians, as for `rotated_about_y`
};
/// Computes the errors over all angles. Squared errors and squares are trigonometric polynomials of degree 2
/// (order - 1) in the angle. They are determined from 4 order - 3 angles, evaluated at 32 order angles, and
/// refined near the maximum.
LitRmsOverRotations lit_rms_over_rotations(const ErrorMoments& moments, const Lighting& lighting);

} // namespace prt
