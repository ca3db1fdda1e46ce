#pragma once

// Edges of surfaces whose two sides lie in different places of an atlas.

#include "prt/texels.h"

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace prt {

/// One place of a surface, where its two sides lie in the atlas: in texels.
struct SeamPoint {
    glm::dvec2 here, there;
};

/// Points along all seams, two a texel at least. An edge is a seam where its triangles have the same normals
/// there, so that light is the same on both sides.
std::vector<SeamPoint> seam_points(const Scene& scene, const Atlas& atlas);

/// Changes `values` [texels][stride] as little as may be, in the sense of least squares, so that bilinear
/// filtering gives the same on both sides of seams. Texels that are not `measured` change freely.
void stitch_seams(const Atlas& atlas, std::span<const SeamPoint> seams, const std::vector<bool>& measured,
                  std::span<float> values, std::size_t stride);

/// What a bilinear filter reads at a place.
inline BilinearTexels bilinear_at(const Atlas& atlas, const glm::dvec2& place) {
    return bilinear_texels(size_of(atlas), place.x, place.y);
}

/// By how much the first number of `values` [texels][stride] jumps across a seam.
double jump_at(const Atlas& atlas, const SeamPoint& point, std::span<const float> values, std::size_t stride);

} // namespace prt
