#pragma once

// Bricks that are split where light between their probes errs.

#include "prt/transfer_volume.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// How many levels below those that surfaces ask for bricks may be split.
inline constexpr int kMostRefinements = 2;

/// The same bricks, as many levels up as there is room for, at most kMostRefinements.
VolumeGrid with_finer_levels(VolumeGrid grid);
/// The same bricks, the finest of them on level 0.
VolumeGrid without_unused_levels(VolumeGrid grid);
/// With those bricks in eight that `splits` [bricks] names.
VolumeGrid with_split_bricks(const VolumeGrid& grid, const std::vector<bool>& splits);

/// Squared error of light at points of a brick and its square, as integrals over the brick's volume: under
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

/// The fewest bricks, those that err most, of which smaller ones would bring the relative L2 over all down to
/// `target`, the root mean square of that under skies and under lamps where there are both; none where it is
/// there, or nothing can be split.
std::vector<bool> bricks_to_split(const VolumeGrid& grid, std::span<const BrickError> errors, double target);

} // namespace prt
