#pragma once

// How far light that is fitted to vertices is from light at points between them.

#include "refine/light_points.h"

#include <vector>

namespace prt {

/// Squared errors of direct light, of the interpolation alone: the noise of rays is in neither.
struct SurfaceError {
    std::vector<double> of_triangles; ///< Σ area |x - T|², below zero where it is less than noise hides
    double norm = 0;                  ///< Σ area |T|²

    /// Over the whole surface, in relative L2.
    double relative_l2() const;
};

/// Fits vertices to each fold of `points`, and judges by the other.
SurfaceError surface_error(const LitMesh& mesh, const LightPoints& points, int threads);

} // namespace prt
