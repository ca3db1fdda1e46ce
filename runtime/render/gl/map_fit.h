#pragma once

// Placement of shadow maps: fitted to the visible part of the scene and the casters between it and the sun.

#include "prt/render/picture.h"
#include "shared_suns.h"

#include <vector>

namespace prt {

/// The visible scene. It is split by distance, so that the resolution of each map can match the pixels of its
/// slice.
struct SeenScene {
    Camera camera;
    int width, height; ///< pixels
    Bounds box;        ///< bounds of the scene
};

/// Depth range of the view.
struct Slice {
    double from, to;                 ///< distances along the view, metres
    std::vector<glm::dvec3> corners; ///< corners of the scene box inside the slice, relative to the eye;
                                     ///< empty: nothing visible
};

/// Returns at most PRT_MAX_SLICES slices, near ones first. Each ends at four times the end distance of the
/// previous one.
std::vector<Slice> slices_of(const SeenScene& seen);

/// Returns the number of texels along a side for which a map of `sun` has two texels per pixel side at the
/// near end of `slice`.
double texels_wanted(const Sun& sun, const Slice& slice, const SeenScene& seen);

/// Returns the map of size x size texels for `sun` and `slice`, which must have corners. It contains all
/// casters towards the sun.
suns::SunMap fitted_map(const Sun& sun, const Slice& slice, const SeenScene& seen, int size);

/// Returns the tangent of the half angle, limited to 1.2 radians, because a map cannot represent half a sky.
double tangent_of(const Sun& sun);

} // namespace prt
