#pragma once

// Environment maps with discs; their light is known in closed form.

#include "prt/core/environment.h"

#include <functional>
#include <vector>

namespace prt::test {

/// A disc of uniform radiance that is added to a sky.
struct PaintedDisc {
    glm::dvec3 towards; ///< unit
    double half_angle;  ///< radians
    glm::dvec3 radiance;

    /// pi sin² of the half angle times the radiance: on a receiver that faces it.
    glm::dvec3 irradiance() const;
};

/// Radiance by direction.
using Radiance = std::function<glm::dvec3(const glm::dvec3& direction)>;

/// An image of `width` pixels in `layout`; each is the mean of its directions: 32 x 32 where an edge of a
/// disc is near, the middle elsewhere. `height` is of lat-long images.
Environment painted_sky(EnvironmentLayout layout, int width, int height, const Radiance& sky,
                        const std::vector<PaintedDisc>& discs);

/// Returns a sky that becomes seven times brighter and bluer from the horizon up, and is bright towards +Z.
glm::dvec3 gradient_sky(const glm::dvec3& direction);
/// Returns the gradient sky with clouds from a degree to a radian wide, twice as bright as the gaps.
glm::dvec3 cloudy_sky(const glm::dvec3& direction);

} // namespace prt::test
