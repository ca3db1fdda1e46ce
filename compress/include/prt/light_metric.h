#pragma once

// What an error of transfer costs: the mean squared error of exit radiance over a family of lightings.

#include "prt/light.h"
#include "prt/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments of the light that a transfer vector is multiplied with, C[i][j] = E[ L[i] L[j] ], summed
/// over the three colors; one channel serves all of them. The expected squared error of exit radiance of a
/// transfer error d is d^T C d (docs/math.md, eq. 22).
struct LightMetric {
    TransferLayout layout;
    std::vector<double> moments; ///< [dimension][dimension], symmetric, positive definite
};

/// Every coefficient alike: relative error is then the `relative_l2` of the transfer vectors themselves.
LightMetric plain_metric(const TransferLayout& layout);

/// Lighting as it is on average, indoors and outdoors, turned any way with equal probability: the band powers
/// of docs/math.md, section 4. Where direct light is a part of its own, half of it is lit by the sky without
/// suns.
LightMetric natural_metric(const TransferLayout& layout);

/// Lightings that belong together. All but `natural` are upright about +Y, and as likely turned about it by
/// one angle as by another.
enum class LightFamily {
    natural, ///< any, any way up
    outdoor, ///< clear, hazy and overcast skies over ground, the sun anywhere between 6 and 85 degrees high
    indoor,  ///< rooms, brighter above than below, each with a lamp or window
    day,     ///< clear skies from hour to hour
};

/// The mean over a family, each lighting scaled to the same mean square of open receivers. Where direct light
/// is a part of its own, suns are apart half of the time. A hundredth of the power is `natural_metric`'s. 0.1
/// to 0.3 s: analytic skies are integrated.
LightMetric metric_of_family(LightFamily family, const TransferLayout& layout);

/// The lightings that a family is made of, their suns apart: what is between them is much like one of them.
/// None of `natural`.
std::vector<Lighting> members_of_family(LightFamily family, int order);

/// The mean over `lights`, each scaled to the same energy and turned about +Y by every angle. A hundredth of
/// the power is `natural_metric`'s, so that no error is free. Throws `Error` when a light has fewer bands
/// than the layout, or all are black.
LightMetric metric_of_lights(std::span<const Lighting> lights, const TransferLayout& layout);
/// All light in one sky each.
LightMetric metric_of_lights(std::span<const Light> lights, const TransferLayout& layout);

/// Weighs lamps so that each costs as much as the others on `transfer`, and all together as much as distant
/// light, where there is any: an error counts alike by day and by night, and whichever lamps are dimmed,
/// however bright they are beside a sky and each other.
LightMetric balanced(LightMetric metric, const TransferView& transfer, std::span<const float> areas,
                     int threads = 0);

/// sqrt( E sum_p a_p |R_p - R'_p|² / E sum_p a_p |R_p|² ), the expectation over the lightings of `metric`:
/// the `lit_rms` of all of them at once. Throws `Error` when layouts or numbers of receivers differ.
double expected_lit_rms(const TransferView& reference, const TransferView& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads = 0);

} // namespace prt
