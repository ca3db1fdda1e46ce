#pragma once

// Where the texels of an atlas lie on surfaces.

#include "texels/charts.h"

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

/// Points within a texel that are asked what they lie on.
inline constexpr std::size_t kSamplesOfTexel = 4;

struct TexelSamples {
    /// By texel, at most kSamplesOfTexel of each. A texel that charts touch has at least one: where all of
    /// its points lie beside the surface, the place of it that is nearest to its middle.
    std::vector<TexelSample> samples;
    /// Of the points that charts cover: those that two of them do, not counting edges.
    double overlapping = 0;
};

TexelSamples sample_texels(std::span<const ChartTriangle> triangles, const Atlas& atlas);

} // namespace prt
