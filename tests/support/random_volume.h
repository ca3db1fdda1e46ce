#pragma once

#include "prt/transfer_volume.h"

#include <random>

namespace prt::test {

/// Parts that a volume has: `direct` of one channel and `indirect` of three, and a lamp.
TransferLayout parts_of_volume(int order);

/// Bricks of levels 1 and 0 beside each other, and a place without any, at origin and spacing that floats
/// hold. Probes are in any cluster, with any weights (as many bits each where `alike`), and see anything from
/// a little to all; every `blind`-th sees nothing.
CompressedVolume random_volume(int order, bool alike, std::mt19937& random, std::size_t blind = 7);

/// The same whose probes are those of `grid`.
CompressedVolume random_volume(const VolumeGrid& grid, int order, bool alike, std::mt19937& random,
                               std::size_t blind);

} // namespace prt::test
