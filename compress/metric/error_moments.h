#pragma once

// Second moments of transfer vectors and of their errors. From these, `lit_rms` under any lighting takes
// microseconds, for any number of receivers. Experimental.

#include "prt/compress/light_metric.h"
#include "prt/core/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments, summed over receivers p with area a_p: `errors` = sum a_p d_p d_p^T with d_p = T_p - T'_p,
/// and `references` = sum a_p T_p T_p^T. T_p is the transfer vector of the reference, T'_p that of the
/// approximation. For each color, exit radiance under lighting L has the squared error L^T errors L and the
/// square L^T references L (docs/math.md, section 4).
struct ErrorMoments {
    TransferLayout layout; ///< layout of the vectors of reference and approximation
    /// Each is [dimension][dimension] and symmetric, with dimension = layout.dimension().
    std::vector<double> errors, references;
};

/// Computes the moments of `reference` and of the errors of `approximation`. `areas` is [receivers] and not
/// negative, which is not checked. Takes dimension² operations per receiver; the memory does not depend on
/// the number of receivers. `threads` 0: all; the result does not depend on it. Throws `Error` if the two
/// transfers differ in layout or in number of receivers.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, int threads = 0);
/// Computes only the moments of the errors, and copies `references`, the result of `second_moments` of
/// `reference` for the same `areas`. Takes half the time of the other overload; use it to compare several
/// approximations with one reference. Throws the same errors.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, std::vector<double> references, int threads = 0);
/// Returns sum a_p T_p T_p^T over the receivers p of `transfer`, [dimension][dimension]: the value of
/// `ErrorMoments::references`. `areas` is [receivers] and not negative, which is not checked. `threads` 0:
/// all.
std::vector<double> second_moments(const TransferView& transfer, std::span<const float> areas,
                                   int threads = 0);

/// Returns the relative L2 error of exit radiance under `lighting`: up to rounding, `lit_rms` of
/// prt/core/error_measures.h. Returns 0 if reference and approximation are black under this lighting, and
/// infinity if only the reference is black. Requires a layout with one output. Throws `Error` if the sky or
/// the suns have fewer bands than the layout, or if `lighting.lamps` has neither 0 nor layout.lamps()
/// elements.
double lit_rms(const ErrorMoments& moments, const LightingView& lighting);

/// Returns the relative L2 error of exit radiance that is expected over the lightings of `metric`: up to
/// rounding, `expected_lit_rms` of prt/compress/light_metric.h. Throws `Error` if the layouts of `metric` and
/// `moments` differ.
double expected_lit_rms(const ErrorMoments& moments, const LightMetric& metric);

/// `lit_rms` under one lighting, rotated about +Y to every angle; lamps do not rotate. At each angle the
/// error is divided by the root mean square of the reference's exit radiance at that angle, or, if larger, by
/// a tenth of its root mean square over all 3D rotations of the lighting. Without this lower limit the error
/// would be infinite at angles without light (docs/math.md, section 4).
struct LitRmsOverRotations {
    /// Square root of: squared error averaged over all angles, divided by squared exit radiance averaged over
    /// all angles, with the same lower limit. Exact, not sampled.
    double mean = 0;
    double worst = 0;       ///< maximum over all angles
    double worst_angle = 0; ///< angle of `worst`: radians, argument of `rotated_about_y`
};
/// Computes the errors over all rotations of `lighting` about +Y. `worst` is evaluated at 32 · order angles
/// and refined near the largest of these. Requires a layout with one output. Throws the errors of `lit_rms`,
/// and `Error` if the sky or the suns are not finite.
LitRmsOverRotations lit_rms_over_rotations(const ErrorMoments& moments, const Lighting& lighting);

} // namespace prt
