#pragma once

// The error measures of docs/math.md, section 6. R is the exit radiance of the reference for albedo 1, R'
// that of the approximation; T and T' are their transfer vectors. `areas` [receivers] are the areas of
// receivers in any unit, not negative: only their ratios count. An error that is divided by 0 is infinite; 0
// / 0 is 0. Experimental.

#include "prt/core/adjacency.h"
#include "prt/core/light.h"
#include "prt/core/transfer_view.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Returns the relative L2 error of transfer vectors, weighted by the areas a_p: sqrt( sum_p a_p |T_p -
/// T'_p|² / sum_p a_p |T_p|² ). Returns 0 if both sums are 0, infinity if only the second sum is 0. If one
/// transfer has color, a grey term of either counts as three equal channels. Transfers with different terms
/// of distant light are compared after `as_combined` of prt/core/transfer.h. Both transfers must have one
/// output. Throws `Error` if the number of receivers, the orders or the lamps (names and sequence) differ, if
/// only one transfer has terms of distant light, and for transfer or areas that are not finite.
double relative_l2(const TransferView& reference, const TransferView& approximation,
                   std::span<const float> areas);

/// Returns the expected contrast error under random light whose SH coefficients are independent and have
/// equal variance: sqrt( sum_p a_p c_p² / sum_p a_p ), with a_p the areas and c_p = |T_p - T'_p| / (|T_p| +
/// T_a). T_a is the `adaptation_luminance` of the lengths |T_p| of all receivers. Treats channels and terms
/// as `relative_l2` does, and throws the same errors.
double transfer_contrast(const TransferView& reference, const TransferView& approximation,
                         std::span<const float> areas);

/// Returns the relative L2 error of exit radiance over three channels, weighted by the areas a_p: sqrt( sum_p
/// a_p |R_p - R'_p|² / sum_p a_p |R_p|² ). Returns 0 if both sums are 0, infinity if only the second sum is
/// 0. All spans are [receivers]. Throws `Error` for numbers that are not finite.
double lit_rms(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
               std::span<const float> areas);

/// Ratio of the adaptation luminance to the logarithmic mean luminance of a picture. The adaptation luminance
/// represents the adaptation of the eye: differences of luminance far below it are invisible (docs/math.md,
/// eq. 33b).
inline constexpr double kAdaptationShare = 0.1;

/// Returns the adaptation luminance Y_a of docs/math.md, eq. 33b, in the unit of `luminances` [receivers]. It
/// is kAdaptationShare times the exponential of the area-weighted mean of log(luminance), over the receivers
/// with positive luminance and area. Luminances below a millionth of their maximum count as a millionth of
/// the maximum. Returns 0 if no receiver has positive luminance and area. Does not check for numbers that are
/// not finite.
double adaptation_luminance(std::span<const double> luminances, std::span<const float> areas);

/// Statistics of jumps along edges: magnitudes of the difference of the errors at the two ends of an edge.
/// The weight of an edge is the sum of the areas of its two ends.
struct EdgeJumps {
    std::size_t edges = 0; ///< number of edges; if it is 0, all other members are 0
    double rms = 0;        ///< root of the weighted mean of the squared jumps; 0 if all weights are 0
    /// Edges with at most 1 % of the total weight have larger jumps; 0 if all weights are 0.
    double percentile_99 = 0;
    double max = 0;   ///< largest jump of all edges, regardless of weight
    Edge worst{0, 0}; ///< edge whose jump is `max`
};
/// Returns statistics of `jumps` [edges], the magnitude of the jump along each edge, in the unit of `jumps`.
/// `areas` is [receivers]; `edges` contains indices of receivers. Does not check for numbers that are not
/// finite.
EdgeJumps edge_jumps(std::span<const Edge> edges, std::span<const double> jumps,
                     std::span<const float> areas);

/// Contrast errors of receivers: errors relative to Y + Y_a (docs/math.md, eq. 33b). Y is the magnitude of
/// the luminance of the picture at the receiver, Y_a the adaptation luminance of the picture.
struct ContrastErrors {
    double adaptation = 0; ///< Y_a, in the unit of luminance; 0 if no receiver is lit
    /// [receivers] sqrt(sum_c l_c (R_c - R'_c)²) / (Y + Y_a), with l_c the luminance weights kLuminance of
    /// the channels. If Y + Y_a is 0: 0 for R = R', else infinity.
    std::vector<double> magnitudes;
    /// [receivers] signed error of luminance: luminance(R - R') / (Y + Y_a), positive if the approximation is
    /// too dark; 0 if Y + Y_a is 0.
    std::vector<double> luminances;
};
/// Returns contrast errors of exit radiance `approximation` against `reference`. Computes Y and Y_a from
/// `shown`, the total radiance of the picture, which may contain light that `reference` lacks; if `shown` is
/// empty, from `reference`. All spans are [receivers]. Does not check for numbers that are not finite.
ContrastErrors contrast_errors(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                               std::span<const float> areas, std::span<const glm::vec3> shown = {});

/// Statistics of `ContrastErrors` over the surface: errors as a person sees them. "Contrast" is
/// `ContrastErrors::magnitudes`; 0.05 is an error of 5 %.
struct VisibleError {
    double adaptation = 0;           ///< adaptation luminance Y_a; 0 if no receiver is lit
    double mean = 0,                 ///< mean of the contrast, weighted by area
        rms = 0,                     ///< root of the mean squared contrast, weighted by area
        percentile_95 = 0,           ///< at most 5 % of the area has a larger contrast
        percentile_99 = 0;           ///< at most 1 % of the area has a larger contrast
    double area_above_5_percent = 0; ///< fraction of the area with a contrast above 0.05, 0..1
    double jumps_99 = 0; ///< 99th percentile of the jumps of `ContrastErrors::luminances` along all
                         ///< edges, weighted by the area of both ends
    /// Jumps of `ContrastErrors::luminances` along edges between two clusters; all 0 if clusters are unknown.
    EdgeJumps seams = {};
};

/// Errors of exit radiance under one lighting. S² is the mean of |R|² over the area, summed over three
/// channels, and M the magnitude of the mean of R over area and channels. Both are those of the reference, or
/// of the `LitScale` passed to `lit_error`.
struct LitError {
    double rms = 0;  ///< root of the area-weighted mean of |R - R'|², divided by S; equals `lit_rms` if S is
                     ///< that of the reference
    double mean = 0; ///< mean of the reference R over area and channels, in its unit, for any `LitScale`
    double max = 0;  ///< largest |R - R'| of a channel at a receiver with positive area, divided by M
    /// The error of a receiver is the largest |R - R'| of its channels, divided by M. This is number
    /// floor(0.999 (n - 1)) of the errors of the n receivers with positive area, counted from 0 in ascending
    /// order and not weighted by area: about 99.9 % of them are not larger. 0 if n is 0.
    double percentile_999 = 0;
    /// `lit_rms` over the half of the area with the smallest sum of R over the channels; relative to R of
    /// that half for any `LitScale`.
    double darker_half_rms = 0;
    /// Jumps of R - R' along edges between two clusters: largest magnitude of the three channels, divided by
    /// M. All 0 if clusters are unknown.
    EdgeJumps crossing;
    /// Jumps of R - R' along edges within one cluster: largest magnitude of the three channels, divided by M.
    /// All 0 if clusters are unknown.
    EdgeJumps inner;
    VisibleError visible; ///< contrast errors
};

/// Levels of radiance that errors of exit radiance are divided by.
struct LitScale {
    double mean_square = 0; ///< mean of |R|² over the area, summed over three channels
    double mean = 0;        ///< mean of R over area and channels; errors are divided by its magnitude
    /// [receivers] total radiance of the picture, the argument of `contrast_errors`; empty: the reference.
    std::vector<glm::vec3> shown = {};
};

/// Returns the means of `reference` [receivers], weighted by `areas`; 0 if the total area is 0. Leaves
/// `LitScale::shown` empty. Throws `Error` for numbers that are not finite.
LitScale lit_scale(std::span<const glm::vec3> reference, std::span<const float> areas);

/// Returns errors of exit radiance `approximation` against `reference`, both [receivers]. `edges` contains
/// indices of receivers; if it is empty, all jumps are 0. `clusters` [receivers], the cluster of each
/// receiver, separates the edges between clusters from those within clusters; without a value `crossing`,
/// `inner` and `visible.seams` are 0. Errors are relative to `scale`; without a value, to
/// `lit_scale(reference, areas)`. Pass `scale` if the lighting is one of many and may leave almost all
/// receivers dark. Throws `Error` for numbers in `reference`, `approximation` or `areas` that are not finite;
/// does not check `scale`.
LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, std::span<const Edge> edges,
                   std::optional<std::span<const std::uint16_t>> clusters,
                   const std::optional<LitScale>& scale = std::nullopt);

} // namespace prt
