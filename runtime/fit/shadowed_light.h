#pragma once

// What suns apart are worth: the light of receivers in shadow, as it is and as coefficients give it.

#include "prt/suns.h"
#include "sky_map.h"

#include <vector>

namespace prt {

/// Receivers whose normals and shadows lie all around (docs/math.md, "Suns in an image"), under one image.
class ShadowedLight {
public:
    ShadowedLight(const SkyMap& whole, int order);

    /// Root mean square of what the receivers lack under `remainder`, of this order, and `suns`, over the
    /// light that they have under the image. 0 where that is black.
    double error(const Light& remainder, const std::vector<SunDisc>& suns) const;

private:
    /// Sees what lies in front of it and on one side of a plane through it.
    struct Receiver {
        glm::dvec3 normal, side;
        /// Of light from `w`.
        double factor(const glm::dvec3& w) const;
    };

    static std::vector<Receiver> receivers();
    std::vector<double> transfer(const Receiver& receiver) const; ///< [order²]

    int order_;
    std::vector<Receiver> receivers_;
    std::vector<glm::dvec3> light_;             ///< exit radiance of each under the image
    std::vector<std::vector<double>> transfer_; ///< [receivers][order²]
    double square_ = 0;                         ///< of light_, summed
};

} // namespace prt
