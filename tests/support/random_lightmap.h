#pragma once

#include "prt/lightmap.h"

#include <random>
#include <vector>

namespace prt::test {

/// Maps of these sizes whose texels are in any cluster, with any weights. Bits of a weight differ, and so do
/// clusters, unless `alike`.
CompressedLightmap random_lightmap(const std::vector<LightmapSize>& maps, int words, bool alike,
                                   std::mt19937& random);

} // namespace prt::test
