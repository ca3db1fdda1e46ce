#pragma once

#include "prt/core/transfer_volume.h"

#include <random>

namespace prt::test {

/// Parts that a volume has: `direct` of one channel and `indirect` of three, and a lamp.
TransferLayout terms_of_volume(int order);

/// Returns a lighting for these terms, of order 3.
Lighting lighting_of_probes();

/// Returns adjacent bricks of levels 1 and 0, and an empty region, with origin and spacing exact in floats.
/// Probes have random clusters and weights (with equal bits if `alike`), and random visibility distances;
/// every `invalid`-th probe is invalid (inside geometry).
CompressedVolume random_volume(int order, bool alike, std::mt19937& random, std::size_t invalid = 7);

/// Returns a random volume with the probes of `grid`.
CompressedVolume random_volume(const VolumeGrid& grid, int order, bool alike, std::mt19937& random,
                               std::size_t invalid);

} // namespace prt::test
