#pragma once

// The error of exit radiance under any lighting at once: second moments of transfer and of its errors, from
// which `lit_rms` under a lighting takes microseconds, whatever the number of receivers. Experimental.

#include "prt/light_metric.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Sums over receivers p of area a_p: exit radiance under L has the squared error L^T (sum a_p d_p d_p^T) L
/// and the square L^T (sum a_p T_p T_p^T) L, d_p = T_p - T'_p, color by color (docs/math.md, section 4).
struct ErrorMoments {
    TransferLayout layout;
    std::vector<double> errors, references; ///< [dimension][dimension] each, symmetric
};

/// Two passes of a symmetric rank-k update: dimension² operations a receiver, and memory that does not grow
/// with the receivers. The result does not depend on `threads`. Throws `Error` when layouts or numbers of
/// receivers differ.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, int threads = 0);
/// The same with `references` known, which are the same for every approximation: half of the work.
ErrorMoments error_moments(const TransferView& reference, const TransferView& approximation,
                           std::span<const float> areas, std::vector<double> references, int threads = 0);
/// `ErrorMoments::references`.
std::vector<double> second_moments(const TransferView& transfer, std::span<const float> areas,
                                   int threads = 0);

/// `lit_rms` of prt/error_measures.h between the two transfers under `lighting`, to rounding. 0 where neither
/// radiates, infinite where only errors do. Throws `Error` where the lighting has fewer bands than the
/// layout.
double lit_rms(const ErrorMoments& moments, const LightingView& lighting);

/// `expected_lit_rms` of prt/light_metric.h. Throws `Error` for a metric of another layout.
double expected_lit_rms(const ErrorMoments& moments, const LightMetric& metric);

/// `lit_rms` of one lighting, turned about +Y as a whole; lamps stay. Errors are compared with the exit
/// radiance at that angle, or with a tenth of its root mean square over all rotations of the lighting in
/// space where that is more: light that vanishes at some angle would make any error infinite there
/// (docs/math.md, section 4).
struct LitRmsOverTurns {
    double mean = 0;        ///< root of the mean squared error over the mean square, over all angles: exact
    double worst = 0;       ///< at the worst angle
    double worst_angle = 0; ///< radians, as `rotated_about_y` takes them
};
/// Squared errors and squares are trigonometric polynomials in the angle, of degree 2(order - 1): known from
/// 4 order - 3 turns, they are looked at 32 order times, and about the largest of those more closely.
LitRmsOverTurns lit_rms_over_turns(const ErrorMoments& moments, const Lighting& lighting);

} // namespace prt
