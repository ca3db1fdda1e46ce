#pragma once

// Light of suns at a pixel, shadowed by rays.

#include "bake/reference/primary_rays.h"
#include "bake/scene/lit_side.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace/disc_directions.h"

#include <vector>

namespace prt {

/// Selects the points of the suns' discs for a sample of a pixel: every `stride`-th from `first` on, with the
/// discs rotated by `turn` radians.
struct DiscSample {
    int first = 0, stride = 1;
    double turn = 0;
};

/// A camera ray with its solid angle.
struct ViewRay {
    glm::vec3 along;
    float solid_angle; ///< solid angle of its part of the picture
};

/// Computes the light of suns at visible surfaces. Thread-safe.
class SunLight {
public:
    /// Keeps references to both. `points`: number of points on the disc of each sun.
    SunLight(const Picture& picture, const TraceScene& scene, int points);

    bool none() const { return suns_.empty(); }
    /// Radiance of sun light that `surface` reflects and transmits along `ray`, including the base color.
    glm::vec3 radiance(const SeenSurface& surface, const ViewRay& ray, const DiscSample& sample) const;

private:
    struct SampledSun {
        DiscDirections directions;
        glm::vec3 irradiance;
    };
    /// Irradiance of a side of a surface.
    glm::vec3 irradiance(const LitSide& side, const DiscSample& sample) const;
    Scattering scattering(const SeenSurface& surface, float footprint) const;

    const Picture& picture_;
    const TraceScene& scene_;
    std::vector<SampledSun> suns_;
};

} // namespace prt
