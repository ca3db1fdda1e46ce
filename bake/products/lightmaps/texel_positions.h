#pragma once

// Positions of samples of texels in space.

#include "bake/products/lightmaps/texel_samples.h"
#include "bake/scene/detailed_surface.h"
#include "bake/scene/ray_starts.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Positions of samples as receivers: on the surface of a scene, or on a detailed surface.
class TexelPositions {
public:
    /// Keeps a reference to `detail`; null: texels are measured on the scene.
    TexelPositions(const Scene& scene, const DetailedSurface* detail);
    /// Appends a receiver of that area on one side of the surface.
    void append(const TexelSample& sample, float area, Receivers& receivers, Side side = Side::front) const;
    /// Returns the position of a sample on the surface of the scene.
    glm::vec3 position(const TexelSample& sample) const;
    /// Surface on which texels are measured; null: the scene.
    const DetailedSurface* detail() const { return detail_; }
    /// Area of a triangle of the scene, m².
    double area(std::uint32_t triangle) const;

private:
    std::vector<glm::uvec3> corners_; ///< [triangles]
    Receivers vertices_;
    const DetailedSurface* detail_;
};

} // namespace prt
