#pragma once

// Small files that hold lightmaps.

#include "prt/render/lightmap_file.h"
#include "support/glb_file.h"

#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace prt::test {

/// Returns a floor of `cells` cells along a side, in two primitives: coordinates 0 fill the square from 0 to
/// 1, coordinates 1 are in four squares around it.
GlbFile mapped_floor(int cells);

/// Its texels in two maps: by coordinates 0 in the first, by coordinates 1 in the second, which repeats.
LightmapLayout layout_of_floor(const LightmapSize& first, const LightmapSize& second);

/// Made-up transfer of two in three texels, and a seam.
BakedLightmap made_up_lightmap(const LightmapLayout& layout, const TransferLayout& transfer,
                               std::mt19937& random);

/// `scene` with a lightmap, as it is written.
GlbFile with_lightmap(const GlbFile& scene, const BakedLightmap& lightmap);
GlbFile with_lightmap(const GlbFile& scene, const CompressedLightmap& lightmap);

/// Adds an image with these bytes and returns its index in `file.json["images"]`.
std::size_t add_image(GlbFile& file, std::span<const std::byte> png, const char* type = "image/png");

} // namespace prt::test
