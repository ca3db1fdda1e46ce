#pragma once

// Measures the difference between light that is fitted to vertices and light at points between them.

#include "bake/refine/light_points.h"

#include <vector>

namespace prt {

/// Squared errors of direct light by interpolation only: both sums are free of ray noise.
struct SurfaceError {
    std::vector<double> of_triangles; ///< Σ area |x - T|²; negative if the error is smaller than the noise
    double norm = 0;                  ///< Σ area |T|²

    /// Relative L2 error over the whole surface.
    double relative_l2() const;
};

/// Fits vertices to each fold of `points`, and tests the fit against the other fold.
SurfaceError surface_error(const LitMesh& mesh, const LightPoints& points, int threads);

} // namespace prt
