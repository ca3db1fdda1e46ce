#pragma once

// Translucent voxels in the place of dense meshes far away, so that rays meet few triangles. Experimental.

#include <cstddef>

namespace prt {

/// What stands in for what, in a bake with BakeOptions::tracer.far_distance.
struct FarBlockerFigures {
    double distance = 0;                  ///< metres, from which on voxels stand in
    double voxel_size = 0;                ///< metres
    std::size_t nodes = 0, triangles = 0; ///< that they stand in for
    std::size_t voxels = 0, bytes = 0;
    double seconds = 0; ///< to make them
    /// Relative L2 of direct light at some receivers, against the triangles themselves.
    double error = 0;
};

} // namespace prt
