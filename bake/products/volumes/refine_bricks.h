#pragma once

// Splits bricks where light between their probes has errors.

#include "prt/core/transfer_volume.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Maximum number of levels by which bricks may be split below the levels that depend on surfaces.
inline constexpr int kMaxRefinements = 2;

/// Returns the same bricks with their levels raised as far as possible, at most by kMaxRefinements.
VolumeGrid with_finer_levels(VolumeGrid grid);
/// Returns the same bricks with the finest of them on level 0.
VolumeGrid without_unused_levels(VolumeGrid grid);
/// Splits the bricks marked in `splits` [bricks] into eight.
VolumeGrid with_split_bricks(const VolumeGrid& grid, const std::vector<bool>& splits);

/// Squared error and squared norm of light at points of a brick, as integrals over the brick's volume: under
/// skies, and under lamps.
struct BrickError {
    std::array<double, 2> error{}, norm{};

    void add(double volume, const BrickError& point) {
        for (std::size_t k = 0; k < 2; ++k) {
            error[k] += volume * point.error[k];
            norm[k] += volume * point.norm[k];
        }
    }
};

/// Returns the smallest set of bricks with the largest errors whose split reduces the relative L2 error of
/// the volume to `target`. If there are skies and lamps, the error is the root mean square of both. No bricks
/// are marked if the target is reached, or if no brick can be split.
std::vector<bool> bricks_to_split(const VolumeGrid& grid, std::span<const BrickError> errors, double target);

} // namespace prt
