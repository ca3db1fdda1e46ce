#pragma once

// Edges of surfaces whose two sides are at different positions of an atlas.

#include "prt/bake/texels.h"

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace prt {

/// A point of a surface, and the positions of its two sides in the atlas, in texels.
struct SeamPoint {
    glm::dvec2 here, there;
};

/// Returns points along all seams, at least two per texel. An edge is a seam if the normals of its triangles
/// are equal there, so that both sides have the same light.
std::vector<SeamPoint> seam_points(const Scene& scene, const Atlas& atlas);

/// Changes `values` [texels][stride] by the minimum, in the least-squares sense, for which bilinear filtering
/// returns the same values on both sides of seams. Texels that are not `measured` change freely.
void stitch_seams(const Atlas& atlas, std::span<const SeamPoint> seams, const std::vector<bool>& measured,
                  std::span<float> values, std::size_t stride);

/// Returns the texels that a bilinear filter reads at a position, and their weights.
inline BilinearTexels bilinear_at(const Atlas& atlas, const glm::dvec2& position) {
    return bilinear_texels(size_of(atlas), position.x, position.y);
}

/// Returns the jump of the first number of `values` [texels][stride] across a seam.
double jump_at(const Atlas& atlas, const SeamPoint& point, std::span<const float> values, std::size_t stride);

} // namespace prt
