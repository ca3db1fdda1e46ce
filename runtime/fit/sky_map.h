#pragma once

// An environment map with lookup of texels near a direction.

#include "runtime/fit/texels.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Returns the mean of the channels, used to find suns: blue and green lamps count equally.
inline double brightness(const glm::dvec3& color) {
    return (color.r + color.g + color.b) / 3;
}

/// A texel near a direction.
struct NearTexel {
    std::size_t texel;
    glm::dvec3 direction;
    double angle;       ///< angle to the query direction
    double solid_angle; ///< positive
    glm::dvec3 color;
};

/// Summary of the texels in a cell of the sphere.
struct SkyCell {
    glm::dvec3 flux{0};      ///< radiance times solid angle
    glm::dvec3 direction{0}; ///< unit, mean weighted by brightness; the cell center if black
    std::size_t brightest = 0;
    double most = -1; ///< brightness of the brightest texel; negative if the cell has no texel
};

/// An image with its texels sorted into the cells of a cube around the viewer.
class SkyMap {
public:
    /// Throws `Error` if a pixel is negative or not finite.
    SkyMap(Environment environment, int threads);

    const Texels& texels() const { return texels_; }
    const Environment& environment() const { return environment_; }
    glm::vec3& pixel(std::size_t texel) { return environment_.image.pixels[texel]; }

    /// Returns the texels whose centers are within `angle` of `direction`.
    std::vector<NearTexel> near(const glm::dvec3& direction, double angle) const;
    /// Returns the summaries of all cells for the current pixels.
    std::vector<SkyCell> cells() const;

private:
    /// Position of a texel in floats, precise to 1e-7 radians.
    struct Placed {
        glm::vec3 direction;
        float solid_angle;
        std::uint32_t texel;
    };
    std::span<const Placed> texels_of(std::size_t cell) const;

    Texels texels_;
    Environment environment_;
    int threads_;
    std::vector<std::uint32_t> first_; ///< [cells + 1] index into sorted_
    std::vector<Placed> sorted_;       ///< sorted by cell
};

} // namespace prt
