#pragma once

// Automatic exposure. Measures the light that comes from the model and ignores the sky behind it.

#include "prt/picture.h"
#include "prt/trace_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// The receivers that the camera of a picture sees, sampled on a coarse grid.
class LightMeter {
public:
    /// Finds the visible receivers by at most 48 x 48 rays. Ignores radiance, transfer and lighting of
    /// `picture`, and keeps no reference to it. `ray_scene` must be built from `*picture.scene`.
    LightMeter(const Picture& picture, const RayScene& ray_scene);

    /// Returns the visible receivers, each once. For a picture with lightmaps these are texels of its layout.
    std::span<const std::uint32_t> receivers() const { return receivers_; }

    /// Returns the mean luminance (Rec. 709) of exit radiance times base color over the pixels that the model
    /// covers; 0 if it covers none. `radiance` [receivers()]: exit radiance for albedo 1.
    float luminance(std::span<const glm::vec3> radiance) const;

private:
    std::vector<std::uint32_t> receivers_;
    std::vector<glm::vec3> weights_; ///< [receivers] weights of red, green and blue in the mean
};

/// Returns the luminance that the suns of `picture` add to `LightMeter::luminance`, by rays towards the suns.
/// `scene` must be built from `*picture.scene`.
float sun_luminance(const Picture& picture, const TraceScene& scene);

/// Returns the factor on radiance that maps `luminance` to 0.22.
float exposure_for(float luminance);

} // namespace prt
