#pragma once

// Numbers of receivers as colors, for pictures. All are [receivers] and are shown as they are, without
// exposure.

#include "prt/adjacency.h"
#include "prt/clustered_transfer.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// From black over red and yellow to white for `share` 0..1.
glm::vec3 heat_color(double share);
/// A color for a number: neighbouring numbers differ, and no two of many are the same.
glm::vec3 label_color(std::size_t label);

/// A color per cluster.
std::vector<glm::vec3> cluster_colors(const ClusteredTransfer& transfer);

/// Components of the receiver's cluster, as heat over the largest number of components there is.
std::vector<glm::vec3> component_colors(const ClusteredTransfer& transfer);

/// Contrast error of exit radiance `approximation` against `reference` (`contrast_errors`): heat over
/// `kWhiteError`.
inline constexpr double kWhiteError = 0.1;
std::vector<glm::vec3> error_colors(std::span<const glm::vec3> reference,
                                    std::span<const glm::vec3> approximation, std::span<const float> areas);

/// The largest jump of the signed contrast error along an edge of the receiver that crosses into another
/// cluster: heat over `kWhiteSeam`. Receivers without such an edge are dark blue.
inline constexpr double kWhiteSeam = 0.05;
std::vector<glm::vec3> seam_colors(std::span<const glm::vec3> reference,
                                   std::span<const glm::vec3> approximation, std::span<const float> areas,
                                   std::span<const Edge> edges, std::span<const std::uint16_t> clusters);

} // namespace prt
