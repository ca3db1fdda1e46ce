#pragma once

// Where shadow maps lie: fitted to what a camera sees and what stands between that and the sun.

#include "prt/picture.h"
#include "sun_structs.h"

#include <vector>

namespace prt {

/// What a picture shows of a scene, cut by distance so that a map for each piece can be as fine as the
/// pixels there.
struct SeenScene {
    Camera camera;
    int width, height; ///< pixels
    Bounds box;        ///< of the scene
};

struct Slice {
    double from, to;                 ///< distances along the view, metres
    std::vector<glm::dvec3> corners; ///< of what of the scene's box lies in it, from the eye; none: nothing
};

/// At most PRT_MOST_SLICES, near ones first: each ends at four times the distance at which the one before
/// it does.
std::vector<Slice> slices_of(const SeenScene& seen);

/// Texels along a side with which a map of `sun` would have two to each pixel and side at the near end of
/// `slice`.
double texels_wanted(const SunDisc& sun, const Slice& slice, const SeenScene& seen);

/// The map of size x size texels for `sun` and `slice`, which has corners. It holds all that blocks light on
/// its way there.
suns::SunMap fitted_map(const SunDisc& sun, const Slice& slice, const SeenScene& seen, int size);

/// Tangent of the half angle, or of 1.2 radians where the sun is wider: no map holds half a sky.
double tangent_of(const SunDisc& sun);

} // namespace prt
