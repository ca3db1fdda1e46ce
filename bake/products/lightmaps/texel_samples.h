#pragma once

// Samples of the texels of an atlas on surfaces.

#include "bake/products/lightmaps/charts.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct TexelSample {
    std::uint32_t texel; ///< row by row
    std::uint32_t triangle;
    glm::vec2 uv; ///< barycentric coordinates of corners 1 and 2
};

/// Number of points within a texel that are projected to the surface.
inline constexpr std::size_t kSamplesOfTexel = 4;

struct TexelSamples {
    /// Samples by texel, at most kSamplesOfTexel per texel. A texel that charts touch has at least one
    /// sample: if all its points are outside the surface, the point of the surface in the texel that is
    /// nearest to its center.
    std::vector<TexelSample> samples;
    /// Share of the points covered by charts that two charts cover, without edges.
    double overlapping = 0;
};

TexelSamples sample_texels(std::span<const ChartTriangle> triangles, const Atlas& atlas);

} // namespace prt
