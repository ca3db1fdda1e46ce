#pragma once

// The error measures of docs/math.md, section 6. All functions throw `Error` for numbers that are not finite.
// A relative error is infinite if the reference is black and the error is not zero. Experimental.

#include "prt/adjacency.h"
#include "prt/light.h"
#include "prt/transfer_view.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Returns the relative L2 error of transfer vectors, weighted by area: sqrt( sum_p a_p |T_p - T'_p|² / sum_p
/// a_p |T_p|² ); 0 if both sums are zero. A grey transfer is compared with a colored one as three equal
/// channels. Transfers with different terms are compared after `as_combined`. Throws `Error` if receivers,
/// orders or lamps differ.
double relative_l2(const TransferView& reference, const TransferView& approximation,
                   std::span<const float> areas);

/// Returns the expected contrast error under light with independent coefficients of equal variance: sqrt(
/// sum_p a_p c_p² / sum_p a_p ), c_p = |T_p - T'_p| / (|T_p| + T_a). T_a is the `adaptation_luminance` of all
/// |T_p|. Treats channels and throws `Error` like `relative_l2`.
double transfer_contrast(const TransferView& reference, const TransferView& approximation,
                         std::span<const float> areas);

/// Returns the relative L2 error of exit radiance for albedo 1 over three channels; both spans are
/// [receivers].
double lit_rms(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
               std::span<const float> areas);

/// Adaptation luminance as a fraction of the logarithmic mean luminance. Differences well below it are
/// invisible (docs/math.md, eq. 33b).
inline constexpr double kAdaptationShare = 0.1;

/// Returns Y_a of eq. 33b: kAdaptationShare times the logarithmic mean of the positive `luminances`, weighted
/// by `areas`; both spans have the same length. Values below a millionth of the maximum count as a millionth
/// of it. Returns 0 if nothing is lit.
double adaptation_luminance(std::span<const double> luminances, std::span<const float> areas);

/// Statistics of the jumps of an error along edges. The weight of an edge is the area of its two ends.
struct EdgeJumps {
    std::size_t edges = 0;
    double rms = 0;
    double percentile_99 = 0; ///< edges with 1 % of the area have larger jumps
    double max = 0;
    Edge worst{0, 0}; ///< the edge with the largest jump
};
/// Computes statistics of `jumps` [edges], which are not negative. `areas` is [receivers].
EdgeJumps edge_jumps(std::span<const Edge> edges, std::span<const double> jumps,
                     std::span<const float> areas);

/// Contrast errors of receivers (docs/math.md, eq. 33b), with Y the luminance of R and Y_a the adaptation
/// luminance. Infinite where there is an error although no receiver is lit.
struct ContrastErrors {
    double adaptation = 0;          ///< Y_a; 0 if nothing is lit
    std::vector<double> magnitudes; ///< [receivers] |R - R'| / (Y + Y_a), channels weighted as in luminance
    std::vector<double> luminances; ///< [receivers] (Y - Y') / (Y + Y_a)
};
/// Computes contrast errors of exit radiance `approximation` against `reference`, all [receivers]. `shown`:
/// total radiance of the picture, from which Y and Y_a are computed; empty: `reference`.
ContrastErrors contrast_errors(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                               std::span<const float> areas, std::span<const glm::vec3> shown = {});

/// Errors as a person sees them: contrast c = |R - R'| / (Y + Y_a), channels weighted as in luminance, with Y
/// the luminance of R and Y_a a tenth of its logarithmic mean over the lit area (docs/math.md, eq. 33b).
/// Percentiles are weighted by area.
struct VisibleError {
    double adaptation = 0; ///< Y_a; 0 if nothing is lit
    double mean = 0, rms = 0, percentile_95 = 0, percentile_99 = 0;
    double area_above_5_percent = 0; ///< fraction of the area
    double jumps_99 = 0;             ///< jumps of (Y - Y') / (Y + Y_a) along edges: 99th percentile, by area
    EdgeJumps seams = {};            ///< jumps of (Y - Y') / (Y + Y_a) along edges between two clusters
};

/// Errors of exit radiance under one lighting. `rms` and `mean` are weighted by area; `max` and
/// `percentile_999` are not.
struct LitError {
    double rms = 0;            ///< `lit_rms`
    double mean = 0;           ///< mean R, weighted by area, over the channels
    double max = 0;            ///< largest |R - R'| of a receiver with area, divided by the mean R
    double percentile_999 = 0; ///< 99.9 % of receivers with area have a smaller |R - R'| / mean R
    /// sqrt of the mean squared error over the mean squared R, for the half of the area with the smallest R.
    double darker_half_rms = 0;
    /// Jumps of exit radiance along edges between two clusters, each the largest of three channels, divided
    /// by the mean R.
    EdgeJumps crossing;
    EdgeJumps inner; ///< jumps along all other edges, in the same measure
    VisibleError visible;
};

/// Levels of the reference to which errors of exit radiance are relative.
struct LitScale {
    double mean_square = 0; ///< mean of |R|² over the receivers, weighted by area, summed over three channels
    double mean = 0;        ///< mean of R over the channels, weighted by area
    /// [receivers] radiance of the picture for the contrast errors; empty: the reference.
    std::vector<glm::vec3> shown = {};
};

/// Computes the means of `reference`; `shown` is left empty.
LitScale lit_scale(std::span<const glm::vec3> reference, std::span<const float> areas);

/// Computes errors of exit radiance `approximation` against `reference`, both [receivers]. Measures jumps
/// along `edges` if `clusters` [receivers] has a value. Errors are relative to the level of `scale` if it is
/// set, otherwise to that of `reference`. Set `scale` if the lighting is one of many and may leave almost
/// everything dark. `darker_half_rms` ignores `scale`.
LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, std::span<const Edge> edges,
                   std::optional<std::span<const std::uint16_t>> clusters,
                   const std::optional<LitScale>& scale = std::nullopt);

} // namespace prt
