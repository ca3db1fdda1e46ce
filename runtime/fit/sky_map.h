#pragma once

// An environment map whose texels can be looked up around a direction.

#include "texels.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// The mean of the channels, by which suns are looked for: a blue lamp counts as much as a green one.
inline double brightness(const glm::dvec3& color) {
    return (color.r + color.g + color.b) / 3;
}

/// A texel near a direction.
struct NearTexel {
    std::size_t texel;
    glm::dvec3 direction;
    double angle;       ///< to that direction
    double solid_angle; ///< above zero
    glm::dvec3 color;
};

/// Texels of a square of the sphere, as far as they are known without looking at each.
struct SkyCell {
    glm::dvec3 flux{0};      ///< radiance over solid angle
    glm::dvec3 direction{0}; ///< unit, the mean by brightness; the middle where it is black
    std::size_t brightest = 0;
    double most = -1; ///< brightness of the brightest; below zero where there is no texel
};

/// An image and its texels, sorted into the cells of a cube around the viewer.
class SkyMap {
public:
    /// Throws `Error` where a pixel is negative or not finite.
    SkyMap(Environment environment, int threads);

    const Texels& texels() const { return texels_; }
    const Environment& environment() const { return environment_; }
    glm::vec3& pixel(std::size_t texel) { return environment_.image.pixels[texel]; }

    /// Texels whose middles lie within `angle` of `direction`.
    std::vector<NearTexel> near(const glm::dvec3& direction, double angle) const;
    /// All cells, of the pixels as they are.
    std::vector<SkyCell> cells() const;

private:
    /// Where a texel lies, in floats: to 1e-7 radians.
    struct Placed {
        glm::vec3 direction;
        float solid_angle;
        std::uint32_t texel;
    };
    std::span<const Placed> texels_of(std::size_t cell) const;

    Texels texels_;
    Environment environment_;
    int threads_;
    std::vector<std::uint32_t> first_; ///< [cells + 1] into sorted_
    std::vector<Placed> sorted_;       ///< by cell
};

} // namespace prt
