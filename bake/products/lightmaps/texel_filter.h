#pragma once

// Light of texels without the noise of its rays.

#include "bake/products/lightmaps/texel_light.h"
#include "bake/surface_fit/noise_filter.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Groups texels of an atlas that are filtered together: adjacent texels on one surface without a fold.
class TexelNet {
public:
    /// `lit` [texels]: those that are filtered.
    TexelNet(const Scene& scene, const Atlas& atlas, std::span<const ChartTriangle> charts,
             std::span<const TexelSample> samples, const TexelPositions& positions,
             const std::vector<bool>& lit);

    /// Equations of rows [first, last) of the atlas.
    FitEquations equations(std::uint32_t first, std::uint32_t last) const;
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

private:
    bool together(std::uint32_t a, std::uint32_t b) const;

    std::uint32_t width_, height_;
    std::vector<glm::dvec3> positions_, normals_; ///< [texels] means of their samples
    std::vector<std::uint32_t> charts_;           ///< [texels]; kNoReceiver for texels without light
    std::vector<float> sizes_;                    ///< [texels] side length on the surface, metres
};

/// Filters direct and bounced light of a sky by one filter, and bounces of lamps by another, as strongly as
/// TexelLight::noise requires. Processes several rows of the atlas at a time. Returns the relative noise that
/// remains in the light of the sky.
double filter_texels(const TexelNet& net, int threads, TexelLight& light);

} // namespace prt
