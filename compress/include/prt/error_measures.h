#pragma once

// The error measures of docs/math.md, section 6.

#include "prt/light.h"
#include "prt/scene.h"
#include "prt/transfer.h"

#include <optional>
#include <span>

namespace prt {

/// sqrt( sum_p a_p |T_p - T'_p|² / sum_p a_p |T_p|² ); 0 when both are zero. A grey transfer compares with a
/// coloured one as three equal channels. Throws `Error` when receivers or orders differ.
double relative_l2(const Transfer& reference, const Transfer& approximation, std::span<const float> areas);

struct LitError {
    double rms = 0;  ///< lit_rms: relative L2 of exit radiance, albedo 1, three channels
    double max = 0;  ///< lit_max: largest |R - R'| of a receiver with area, over the mean R
    double seam = 0; ///< largest jump of R - R' along an edge between two clusters, over the mean R
    double mean = 0; ///< mean R, area-weighted, over the channels
};

/// Errors of exit radiance `approximation` against `reference`, both [receivers].
/// `clusters` [receivers]: where given, `seam` is measured along the edges of `scene`.
LitError lit_error(std::span<const glm::vec3> reference, std::span<const glm::vec3> approximation,
                   std::span<const float> areas, const Scene& scene,
                   std::optional<std::span<const std::uint16_t>> clusters);

} // namespace prt
