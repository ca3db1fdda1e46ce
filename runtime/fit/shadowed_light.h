#pragma once

// Benefit of separate suns: compares the exact light of shadowed receivers with the light from coefficients.

#include "prt/fit/suns.h"
#include "runtime/fit/sky_map.h"

#include <vector>

namespace prt {

/// Receivers with evenly distributed normals and shadow planes (docs/math.md, "Suns in an image"), under one
/// image.
class ShadowedLight {
public:
    ShadowedLight(const SkyMap& whole, int order);

    /// Returns the root mean square difference between the light under `remainder` (of order `order`) plus
    /// `suns` and the light under the image, relative to the latter. Returns 0 if that is black.
    double error(const Light& remainder, const std::vector<Sun>& suns) const;

private:
    /// Receiver that sees the hemisphere about `normal`, restricted to one side of a plane.
    struct Receiver {
        glm::dvec3 normal, side;
        /// Returns the contribution factor of light from `w`.
        double factor(const glm::dvec3& w) const;
    };

    static std::vector<Receiver> receivers();
    std::vector<double> transfer(const Receiver& receiver) const; ///< [order²]

    int order_;
    std::vector<Receiver> receivers_;
    std::vector<glm::dvec3> light_;             ///< exit radiance of each receiver under the image
    std::vector<std::vector<double>> transfer_; ///< [receivers][order²]
    double square_ = 0;                         ///< sum of squares of light_
};

} // namespace prt
