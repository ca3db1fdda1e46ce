#pragma once

// Visualisation of receiver data as colors. Colors of receivers are [receivers] and are shown without
// exposure.

#include "prt/adjacency.h"
#include "prt/clustered_transfer.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns a heat color for `share` in 0..1: black, red, yellow, white.
glm::vec3 heat_color(double share);
/// Returns a color for a number. Colors of consecutive numbers differ strongly, and no color is repeated.
glm::vec3 label_color(std::size_t label);

/// Returns a color for each receiver that identifies its cluster.
std::vector<glm::vec3> cluster_colors(const ClusteredTransfer& transfer);

/// Returns the number of components of each receiver's cluster, relative to the maximum number, as
/// `heat_color`.
std::vector<glm::vec3> component_colors(const ClusteredTransfer& transfer);

/// Contrast error that `error_colors` shows as white.
inline constexpr double kWhiteError = 0.1;

/// Returns the contrast error of exit radiance `approximation` against `reference` (`contrast_errors`),
/// relative to `kWhiteError`, as `heat_color`.
std::vector<glm::vec3> error_colors(std::span<const glm::vec3> reference,
                                    std::span<const glm::vec3> approximation, std::span<const float> areas);

/// Jump of the contrast error that `seam_colors` shows as white.
inline constexpr double kWhiteSeam = 0.05;

/// Returns for each receiver the maximum jump of the signed contrast error along its edges to other clusters,
/// relative to `kWhiteSeam`, as `heat_color`. Receivers without such an edge are dark blue.
std::vector<glm::vec3> seam_colors(std::span<const glm::vec3> reference,
                                   std::span<const glm::vec3> approximation, std::span<const float> areas,
                                   std::span<const Edge> edges, std::span<const std::uint16_t> clusters);

} // namespace prt
