#pragma once

// Areas of the surface that filters read from texels.

#include "bake/products/lightmaps/texel_positions.h"

#include <span>
#include <vector>

namespace prt {

/// Texels that charts touch and their neighbours, by their indices in the atlas, ascending.
struct TexelAreas {
    std::vector<std::uint32_t> texels;
    /// m²: area of the surface that a bilinear filter reads from each texel, estimated from samples of
    /// texels.
    std::vector<float> areas;
};

/// Returns the area of a chart's triangle in texels.
double area_in_texels(const ChartTriangle& triangle);
/// Returns the area of the surface that a sample on the triangle represents, m²: its share of a texel.
double area_of_sample(const ChartTriangle& triangle, const TexelPositions& positions);

TexelAreas texel_areas(const Atlas& atlas, std::span<const ChartTriangle> charts,
                       const TexelPositions& positions, std::span<const TexelSample> samples);

} // namespace prt
