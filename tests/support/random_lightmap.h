#pragma once

#include "prt/core/lightmap.h"

#include <random>
#include <vector>

namespace prt::test {

/// Returns maps of these sizes whose texels have random clusters and weights. Bits of weights and clusters
/// differ, unless `alike`.
CompressedLightmap random_lightmap(const std::vector<LightmapSize>& maps, int words, bool alike,
                                   std::mt19937& random);

} // namespace prt::test
