#pragma once

// Where the texels of an environment map lie on the sphere.

#include "prt/environment.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Middles and solid angles of the texels of an image, by their index [height][width]. Thread-safe.
class Texels {
public:
    /// The image's pixels do not matter; its shape has been checked.
    explicit Texels(const Environment& environment);

    std::size_t count() const { return width_ * height_; }
    glm::dvec3 direction(std::size_t texel) const; ///< unit
    /// Of what `project` counts: zero in the corners of angular maps.
    double solid_angle(std::size_t texel) const;
    /// The widest step from a texel to the next, radians.
    double spacing() const { return spacing_; }

private:
    /// What a texel covers along one axis.
    struct Cell {
        double begin, end;
        double middle() const { return 0.5 * (begin + end); }
    };
    struct CellPair {
        Cell u, v;
    };
    struct Turn {
        double cosine, sine;
    };

    void set_lat_long();
    void set_square(EnvironmentLayout layout);
    CellPair square(std::size_t texel) const;

    EnvironmentLayout layout_;
    LatLongCenter center_;
    std::size_t width_, height_;
    double spacing_ = 0;
    std::vector<Turn> polar_, azimuth_;   ///< of the rows and columns of a lat-long image
    std::vector<double> row_solid_angle_; ///< of each texel of a row
    std::vector<Cell> cells_;             ///< of a square's rows and columns, in [-1, 1]
};

} // namespace prt
