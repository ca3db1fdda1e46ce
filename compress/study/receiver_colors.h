#pragma once

// Shows data of receivers as colors. All colors are linear Rec. 709 in 0..1. Functions return one color per
// receiver, [receivers]; a renderer shows these colors without lighting and exposure.

#include "prt/core/adjacency.h"
#include "prt/core/clustered_transfer.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns a color that changes from black (`share` 0) to red (1/3), yellow (2/3) and white (1). Values of
/// `share` outside 0..1 are clamped.
glm::vec3 heat_color(double share);
/// Returns a color for the number `label`, to distinguish clusters or charts. Colors of consecutive numbers
/// differ strongly. All numbers below 65 536 have different colors.
glm::vec3 label_color(std::size_t label);

/// Returns for each receiver the `label_color` of its cluster index.
std::vector<glm::vec3> cluster_colors(const ClusteredTransfer& transfer);

/// Returns for each receiver the `heat_color` of the number of components of its cluster, divided by the
/// maximum number of components of a cluster.
std::vector<glm::vec3> component_colors(const ClusteredTransfer& transfer);

/// Contrast error that `error_colors` shows as white: 0.1 = 10 %.
inline constexpr double kWhiteError = 0.1;

/// Returns for each receiver the `heat_color` of its contrast error (`ContrastErrors::magnitudes`), divided
/// by `kWhiteError`. `approximation` and `reference` are exit radiance; they and `areas` are [receivers]. All
/// numbers must be finite, which is not checked.
std::vector<glm::vec3> error_colors(std::span<const glm::vec3> reference,
                                    std::span<const glm::vec3> approximation, std::span<const float> areas);

/// Jump of the contrast error that `seam_colors` shows as white: 0.05 = 5 %.
inline constexpr double kWhiteSeam = 0.05;

/// Returns for each receiver the `heat_color` of its maximum jump divided by `kWhiteSeam`. A jump is the
/// absolute difference of the signed contrast errors (`ContrastErrors::luminances`) at the two ends of an
/// edge between two clusters. Receivers without such an edge are dark blue. `approximation` and `reference`
/// are exit radiance. All arrays except `edges` are [receivers], and `edges` has indices of receivers;
/// `clusters` is the cluster of each receiver. All numbers must be finite, which is not checked.
std::vector<glm::vec3> seam_colors(std::span<const glm::vec3> reference,
                                   std::span<const glm::vec3> approximation, std::span<const float> areas,
                                   std::span<const Edge> edges, std::span<const std::uint16_t> clusters);

} // namespace prt
