#pragma once

// Cost of a transfer error: the mean squared error of exit radiance over a family of lightings.

#include "prt/light.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments of the light L that a transfer vector is multiplied with: C[i][j] = E[ L[i] L[j] ], summed
/// over the three colors. A term with a single channel is used for all three. The expected squared error of
/// exit radiance of a transfer error d is d^T C d (docs/math.md, eq. 22).
struct LightMetric {
    TransferLayout layout;
    std::vector<double> moments; ///< [dimension][dimension], symmetric, positive definite
};

/// Returns the metric in which all coefficients have the same weight. The relative error is then
/// `relative_l2` of the transfer vectors.
LightMetric plain_metric(const TransferLayout& layout);

/// Returns the metric of average lighting, indoors and outdoors, with all 3D rotations equally likely: the
/// band powers of docs/math.md, section 4. If direct light is a separate term, half of it is lit by the sky
/// without suns.
LightMetric natural_metric(const TransferLayout& layout);

/// Families of lightings. All except `natural` are upright about +Y, with all rotations about it equally
/// likely.
enum class LightFamily {
    natural, ///< any lighting, any orientation
    outdoor, ///< clear, hazy and overcast skies over ground, the sun at 6 to 85 degrees elevation
    indoor,  ///< rooms, brighter above than below, each with a lamp or window
    day,     ///< clear skies at different hours
};

/// Returns the mean over the lightings of a family, each scaled to the same mean square over unoccluded
/// receivers. If direct light is a separate term, suns are separate in half of the cases. A hundredth of the
/// power is `natural_metric`. Takes 0.1 to 0.3 s, because analytic skies are integrated.
LightMetric metric_of_family(LightFamily family, const TransferLayout& layout);

/// Returns typical lightings of a family, with separate suns; other lightings of the family are similar to
/// one of them. Empty for `natural`.
std::vector<Lighting> members_of_family(LightFamily family, int order);

/// Returns the mean over `lights`, each scaled to the same energy, and over all rotations about +Y. A
/// hundredth of the power is `natural_metric`, so that every error has a cost. Throws `Error` if a light has
/// fewer bands than the layout, or all are black.
LightMetric metric_of_lights(std::span<const Lighting> lights, const TransferLayout& layout);
/// Returns the metric of skies without separate suns: the mean over `lights`, scaled and rotated as for
/// `Lighting`.
LightMetric metric_of_lights(std::span<const Light> lights, const TransferLayout& layout);

/// Returns `metric` with its lamps scaled: on `transfer` each lamp has the same cost, and all lamps together
/// have the cost of distant light, if there is any. An error then has the same weight by day, by night and
/// for any dimming, for any brightness of the lamps relative to the sky and to each other.
LightMetric balanced(LightMetric metric, const TransferView& transfer, std::span<const float> areas,
                     int threads = 0);

/// Returns the expected `lit_rms` over the lightings of `metric`: sqrt( E sum_p a_p |R_p - R'_p|² / E sum_p
/// a_p |R_p|² ). Throws `Error` if layouts or numbers of receivers differ.
double expected_lit_rms(const TransferView& reference, const TransferView& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads = 0);

} // namespace prt
