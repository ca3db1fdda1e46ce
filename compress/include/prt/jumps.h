#pragma once

// Jumps of the error across the borders of clusters, which show as seams. Experimental.

#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/transfer_view.h"

#include <cstdint>
#include <span>

namespace prt {

/// Share of the area beside borders where jumps may be larger than what is said of them.
inline constexpr double kJumpsBeyond = 0.01;

/// A jump that nobody sees on a surface of one colour: on a head under a sunset, 8 % show nothing, 11 % the
/// first blotches.
inline constexpr double kUnseenJump = 0.05;

/// The 99th percentile, over the mesh edges whose ends have different `clusters` [receivers], each counted by
/// the areas of both, of how the error of exit radiance differs between the ends: root of the mean square
/// under `metric`, over that of the mean exit radiance of all receivers by area: sqrt(d^T C d / m^T C m). 0
/// without such edges. Throws `Error` when layouts or numbers of receivers differ.
double jump_across_clusters(const TransferView& reference, const TransferView& approximation,
                            std::span<const std::uint16_t> clusters, const ReceiverSurface& surface,
                            const LightMetric& metric, int threads = 0);

/// Rotations about +Y, by equal angles, at which `worst_jump_across_clusters` looks.
inline constexpr int kRotationsOfJumps = 24;

/// The greatest of the same percentile under each of `skies` alone, at each of its rotations: under one
/// lighting the error of exit radiance differs between the ends of an edge by |sum_i L_i d_i|, the root of
/// the mean square over the colors, over that of the mean exit radiance. Skies that leave the mean dark do
/// not count.
double worst_jump_across_clusters(const TransferView& reference, const TransferView& approximation,
                                  std::span<const std::uint16_t> clusters, const ReceiverSurface& surface,
                                  std::span<const Lighting> skies, int threads = 0);

} // namespace prt
