#pragma once

// What a picture adds at a pixel for suns: their light, shadowed by rays.

#include "pictures/lit_side.h"
#include "pictures/primary_rays.h"
#include "prt/trace_scene.h"
#include "trace/disc_directions.h"

#include <vector>

namespace prt {

/// Which points of the suns' discs a sample of a pixel takes: every `stride`-th from `first` on, of discs
/// that are turned by `turn` radians.
struct DiscSample {
    int first = 0, stride = 1;
    double turn = 0;
};

/// A ray of a camera and what it stands for.
struct ViewRay {
    glm::vec3 along;
    float solid_angle; ///< of its share of the picture
};

/// Thread-safe.
class SunLight {
public:
    /// Keeps references to both. `points` on the disc of each sun.
    SunLight(const Picture& picture, const TraceScene& scene, int points);

    bool none() const { return suns_.empty(); }
    /// What `surface` sends back along `ray`, base color included.
    glm::vec3 radiance(const SeenSurface& surface, const ViewRay& ray, const DiscSample& sample) const;

private:
    struct Sun {
        DiscDirections directions;
        glm::vec3 irradiance;
    };
    /// On a side of a surface.
    glm::vec3 irradiance(const LitSide& side, const DiscSample& sample) const;
    Scattering scattering(const SeenSurface& surface, float footprint) const;

    const Picture& picture_;
    const TraceScene& scene_;
    std::vector<Sun> suns_;
};

} // namespace prt
