#pragma once

// What an error of transfer costs: the mean squared error of exit radiance over a family of lightings.

#include "prt/light.h"
#include "prt/transfer.h"

#include <span>
#include <vector>

namespace prt {

/// Second moments of lighting, C_c[i][j] = E[ L_c[i] L_c[j] ]. The expected squared error of exit radiance of
/// a transfer error d is sum_c d_c^T C_c d_c (docs/math.md, eq. 22).
struct LightMetric {
    int order = 0;
    int channels = 1;
    std::vector<double> moments; ///< [channels][order²][order²], symmetric, positive definite
};

/// Every coefficient alike: relative error is then the `relative_l2` of the transfer vectors themselves.
LightMetric plain_metric(int order, int channels);

/// Lighting as it is on average, turned any way with equal probability: a coefficient of band l has the power
/// 1/(4 l) of that of band 0 (docs/math.md, section 4, says where that is from).
LightMetric natural_metric(int order, int channels);

/// The mean over `lights`, each scaled to the same energy and turned about +Y by every angle. A hundredth of
/// the power is `natural_metric`'s, so that no error is free. Throws `Error` when a light has fewer bands
/// than `order`, or all are black.
LightMetric metric_of_lights(std::span<const Light> lights, int order, int channels);

/// sqrt( E sum_p a_p |R_p - R'_p|² / E sum_p a_p |R_p|² ), the expectation over the lightings of `metric`:
/// the `lit_rms` of all of them at once. Throws `Error` when orders or numbers of receivers differ.
double expected_lit_rms(const Transfer& reference, const Transfer& approximation,
                        std::span<const float> areas, const LightMetric& metric, int threads = 0);

} // namespace prt
