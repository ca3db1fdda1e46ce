#pragma once

// The error measures of docs/math.md, section 6. They throw `Error` for numbers that are not finite, and are
// infinite where an error has nothing but black to compare with. Experimental.

#include "prt/adjacency.h"
#include "prt/light.h"
#include "prt/transfer_view.h"

#include <optional>
#include <span>
#include <vector>

namespace prt {

/// sqrt( sum_p a_p |T_p - T'_p|² / sum_p a_p |T_p|² ); 0 when both are zero. A grey transfer compares with a
/// colored one as three equal channels; transfer of other parts as a whole. Throws `Error` when receivers or
/// orders differ.
double relative_l2(const TransferView& reference, const TransferView& approximation,
                   std::span<const float> areas);

/// sqrt( sum_p a_p c_p² / sum_p a_p ), c_p = |T_p - T'_p| / (|T_p| + T_a) with T_a the adaptation to |T_p|:
/// the contrast error to expect under light whose coefficients are independent and have one variance.
/// Channels and errors as for `relative_l2`.
double transfer_contrast(const TransferView& reference, const TransferView& approximation,
                         std::span<const float> areas);

/// Relative L2 of exit radiance, albedo 1, three channels, both [receivers].
double lit_rms(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
               std::span<const float> areas);

/// Share of the logarithmic mean of the luminance below which eyes see no differences (docs/math.md, eq.
/// 33b).
inline constexpr double kAdaptationShare = 0.1;

/// Y_a of eq. 33b: kAdaptationShare of the logarithmic mean of `luminances` over what has light, weighted by
/// `areas`, both of the same length. Light below a millionth of the largest counts as a millionth of it. 0
/// where nothing is lit.
double adaptation_luminance(std::span<const double> luminances, std::span<const float> areas);

/// Jumps of an error along edges. An edge counts as much as the area of its two ends.
struct EdgeJumps {
    std::size_t edges = 0;
    double rms = 0;
    double percentile_99 = 0; ///< 1 % of the area beside the edges has larger jumps
    double max = 0;
    Edge worst{0, 0}; ///< the edge with the largest jump
};
/// `jumps`: one per edge, not negative. `areas` [receivers].
EdgeJumps edge_jumps(std::span<const Edge> edges, std::span<const double> jumps,
                     std::span<const float> areas);

/// Contrast errors of receivers, [receivers], with Y_a as in `VisibleError`; infinite where there is an error
/// and no light at all.
struct ContrastErrors {
    double adaptation = 0;          ///< Y_a; 0: nothing is lit
    std::vector<double> magnitudes; ///< |R - R'| / (Y + Y_a), weighted by channel as luminance is
    std::vector<double> luminances; ///< (Y - Y') / (Y + Y_a)
};
/// `shown`: radiance that the picture has, where that is not `reference` alone.
ContrastErrors contrast_errors(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                               std::span<const float> areas, std::span<const glm::vec3> shown = {});

/// Errors as a viewer sees them: contrast c = |R - R'| / (Y + Y_a), both weighted by channel as luminance is,
/// with Y the luminance of R and Y_a a tenth of its logarithmic mean over the area that has light
/// (docs/math.md, eq. 33b). Percentiles by area.
struct VisibleError {
    double adaptation = 0; ///< Y_a; 0: nothing is lit
    double mean = 0, rms = 0, percentile_95 = 0, percentile_99 = 0;
    double area_above_5_percent = 0; ///< share of the area
    double jumps_99 = 0;             ///< of (Y - Y') / (Y + Y_a) along edges: 99th percentile, by area
    EdgeJumps seams = {};            ///< the same along edges between two clusters
};

struct LitError {
    double rms = 0;            ///< lit_rms
    double mean = 0;           ///< mean R, area-weighted, over the channels
    double max = 0;            ///< lit_max: largest |R - R'| of a receiver with area, over the mean R
    double percentile_999 = 0; ///< the same, 99.9 % of receivers with area are below
    /// sqrt of the mean squared error over the mean squared R, of the half of the area where R is least.
    double darker_half_rms = 0;
    /// Jumps of exit radiance, each the largest of three channels, over the mean R: along edges between two
    /// clusters.
    EdgeJumps crossing;
    EdgeJumps inner; ///< the same along all other edges
    VisibleError visible;
};

/// What errors of exit radiance are measured in.
struct LitScale {
    double mean_square = 0; ///< area-weighted mean of |R|² over the receivers, three channels together
    double mean = 0;        ///< area-weighted mean of R over the channels
    /// [receivers] radiance of the picture, by which contrast is measured; empty: the reference.
    std::vector<glm::vec3> shown = {};
};

/// `shown` is left empty.
LitScale lit_scale(std::span<const glm::vec3> reference, std::span<const float> areas);

/// Errors of exit radiance `approximation` against `reference`, both [receivers]. `clusters` [receivers]:
/// where given, jumps are measured along `edges`. `scale`: what errors are relative to instead of `reference`
/// itself, for one of many lights under which next to nothing may be lit; `darker_half_rms` does not heed it.
LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, std::span<const Edge> edges,
                   std::optional<std::span<const std::uint16_t>> clusters,
                   const std::optional<LitScale>& scale = std::nullopt);

} // namespace prt
