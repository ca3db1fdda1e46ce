#pragma once

// Positions of the texels of an environment map on the sphere.

#include "prt/core/environment.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Centers and solid angles of the texels of an image, by their index [height][width]. Thread-safe.
class Texels {
public:
    /// Uses only layout and size of the image, which must be valid.
    explicit Texels(const Environment& environment);

    std::size_t count() const { return width_ * height_; }
    glm::dvec3 direction(std::size_t texel) const; ///< unit
    /// Returns the solid angle of the part that `project` uses: zero in the corners of angular maps.
    double solid_angle(std::size_t texel) const;
    /// Maximum angle between adjacent texels, radians.
    double spacing() const { return spacing_; }

private:
    /// Interval that a texel covers along one axis.
    struct Cell {
        double begin, end;
        double middle() const { return 0.5 * (begin + end); }
    };
    struct CellPair {
        Cell u, v;
    };
    struct Rotation {
        double cosine, sine;
    };

    void set_lat_long();
    void set_square(EnvironmentLayout layout);
    CellPair square(std::size_t texel) const;

    EnvironmentLayout layout_;
    LatLongCenter center_;
    std::size_t width_, height_;
    double spacing_ = 0;
    std::vector<Rotation> polar_, azimuth_; ///< rows and columns of a lat-long image
    std::vector<double> row_solid_angle_;   ///< per texel, for each row
    std::vector<Cell> cells_;               ///< rows and columns of a square layout, in [-1, 1]
};

} // namespace prt
