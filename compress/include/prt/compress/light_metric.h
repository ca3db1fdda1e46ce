#pragma once

// Cost of a transfer error: the mean squared error of exit radiance over a set of lightings. The functions
// that create a metric require a layout with one output, which is not checked; `incident_metric`
// (prt/compress/compress.h) extends a metric to several outputs.

#include "prt/core/light.h"
#include "prt/core/transfer_view.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments of the light L that a transfer vector is multiplied with: C[i][j] = E[ L[i] L[j] ], the
/// expected value over the lightings of the metric. The moments are summed over red, green and blue, or
/// averaged over them if all terms of the layout have one channel. A transfer error d then has the expected
/// squared error of exit radiance d^T C d (docs/math.md, eq. 22).
struct LightMetric {
    TransferLayout layout;       ///< layout of the transfer vectors to which the metric applies
    std::vector<double> moments; ///< [dimension][dimension], symmetric, positive definite
};

/// Returns the metric in which all coefficients have the same weight; a coefficient of a grey term counts
/// three times next to terms with three channels. `expected_lit_rms` under this metric is `relative_l2`.
/// Throws `Error` if `layout` is invalid.
LightMetric plain_metric(const TransferLayout& layout);

/// Returns the metric of average lighting, indoors and outdoors, with all 3D rotations equally likely: the
/// band powers of docs/math.md, section 4. If the layout has both a direct and an indirect term, the direct
/// term receives the suns in only half of the cases (in the other half the renderer adds them). All other
/// terms always receive them. Lamps have strength 1 and are uncorrelated. Throws `Error` if `layout` is
/// invalid.
LightMetric natural_metric(const TransferLayout& layout);

/// Families of lightings. In all families except `natural`, +Y is up, and all rotations about +Y are equally
/// likely.
enum class LightFamily {
    natural, ///< any lighting, any orientation: `natural_metric`
    outdoor, ///< clear, hazy and overcast skies over ground, the sun at 6 to 85 degrees elevation
    indoor,  ///< rooms, brighter above than below, each with one lamp or window
    day,     ///< clear skies at different hours, the sun at 11 to 45 degrees elevation
};

/// Returns the weighted mean of the second moments over the lightings of a family, each scaled to the same
/// mean square of exit radiance over unoccluded receivers. If the layout has a direct term, this term
/// receives the suns in only half of the cases. Adds the distant part of `natural_metric` with a hundredth of
/// the power, so that every error has a cost. Lamps are uncorrelated, and have the same power relative to
/// distant light as in `natural_metric`. Returns `natural_metric` for `natural`, and for a layout with lamps
/// only. Takes 0.1 to 0.3 s, because analytic skies are integrated. Throws `Error` if `layout` is invalid.
LightMetric metric_of_family(LightFamily family, const TransferLayout& layout);

/// Returns typical lightings of a family as SH of `order` bands (1..kMaxOrder), with separate suns if they
/// have any; other lightings of the family are similar to one of these. Returns an empty vector for
/// `natural`. Throws `Error` for another family if `order` is out of range.
std::vector<Lighting> members_of_family(LightFamily family, int order);

/// Returns the mean of the second moments over `lights`, each scaled to the same energy (sum of squared
/// coefficients of sky plus suns), and over all rotations about +Y. The scale of the result is arbitrary. A
/// direct term receives only the sky, other terms of distant light receive sky plus suns, as in `Lighting`.
/// Ignores black lights and `Lighting::lamps`: lamps are uncorrelated, and have the same power relative to
/// distant light as in `natural_metric`. Adds the distant part of `natural_metric` with a hundredth of the
/// power, so that every error has a cost. Throws `Error` if the layout is invalid, if a light has fewer bands
/// than the layout or is not finite, or if no light reaches a term of distant light (no lights, only black
/// lights, or a layout with lamps only).
LightMetric metric_of_lights(std::span<const Lighting> lights, const TransferLayout& layout);
/// Returns the metric for skies without separate suns, by the other overload of `metric_of_lights`: direct
/// terms receive the same light as the other terms. Throws the same errors.
LightMetric metric_of_lights(std::span<const Light> lights, const TransferLayout& layout);

/// Returns `metric` with a new factor for each lamp. Costs are measured on the vectors of `transfer` (cost of
/// replacing them by 0), weighted by `areas` [receivers]. With these factors each lamp has the same cost, and
/// all lamps together have the cost of distant light; if distant light has no cost, the sum of the lamps'
/// costs does not change. An error then has the same weight by day and by night, for any strength of the
/// lamps. Lamps without effect on the receivers keep their factor. `metric` and `transfer` must have the same
/// layout, which is not checked. `threads` 0: all.
LightMetric balanced(LightMetric metric, const TransferView& transfer, std::span<const float> areas,
                     int threads = 0);

/// Returns the relative L2 error of exit radiance that is expected over the lightings of `metric`: sqrt( E
/// sum_p a_p |R_p - R'_p|² / E sum_p a_p |R_p|² ), with a_p from `areas` [receivers], R_p the exit radiance
/// by `reference` and R'_p that by `approximation`. Returns 0 if both are black, and infinity if only the
/// reference is black. `threads` 0: all. Throws `Error` if layouts or numbers of receivers differ.
double expected_lit_rms(const TransferView& reference, const TransferView& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads = 0);

} // namespace prt
