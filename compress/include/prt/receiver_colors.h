#pragma once

// Visualisation of receiver data as colors. All results are [receivers] and are shown without exposure.

#include "prt/adjacency.h"
#include "prt/clustered_transfer.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns a color from black over red and yellow to white for `share` 0..1.
glm::vec3 heat_color(double share);
/// Returns a color for a number: consecutive numbers differ strongly, and colors do not repeat.
glm::vec3 label_color(std::size_t label);

/// Returns a color per cluster.
std::vector<glm::vec3> cluster_colors(const ClusteredTransfer& transfer);

/// Returns the number of components of each receiver's cluster, as heat relative to the maximum number.
std::vector<glm::vec3> component_colors(const ClusteredTransfer& transfer);

/// Returns the contrast error of exit radiance `approximation` against `reference` (`contrast_errors`), as
/// heat relative to `kWhiteError`.
inline constexpr double kWhiteError = 0.1;
std::vector<glm::vec3> error_colors(std::span<const glm::vec3> reference,
                                    std::span<const glm::vec3> approximation, std::span<const float> areas);

/// Returns the maximum jump of the signed contrast error along edges from the receiver to another cluster, as
/// heat relative to `kWhiteSeam`. Receivers without such an edge are dark blue.
inline constexpr double kWhiteSeam = 0.05;
std::vector<glm::vec3> seam_colors(std::span<const glm::vec3> reference,
                                   std::span<const glm::vec3> approximation, std::span<const float> areas,
                                   std::span<const Edge> edges, std::span<const std::uint16_t> clusters);

} // namespace prt
