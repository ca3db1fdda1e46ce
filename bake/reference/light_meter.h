#pragma once

// Automatic exposure. Measures the light that comes from the model and ignores the sky behind the model.

#include "bake/scene/trace_scene.h"
#include "prt/render/picture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// The receivers that the camera of a picture sees, sampled on a coarse grid of pixels.
class LightMeter {
public:
    /// Finds the visible receivers with at most 48 x 48 rays, which pass transparent surfaces and back sides
    /// of single-sided surfaces. Ignores radiance, transfer and lighting of `picture`. `ray_scene` must be
    /// built from `*picture.scene`. Keeps no reference to the arguments.
    LightMeter(const Picture& picture, const RayScene& ray_scene);

    /// Returns the visible receivers, each once, in ascending order; empty if the model is not visible. For a
    /// picture with lightmaps these are texels of its layout.
    std::span<const std::uint32_t> receivers() const { return receivers_; }

    /// Returns the mean luminance (Rec. 709) of exit radiance times base color over the pixels that the model
    /// covers; 0 if the model covers no pixel. Emission is not included. `radiance`: exit radiance for albedo
    /// 1, linear Rec. 709, one entry per entry of `receivers()`. Negative values count as 0.
    float luminance(std::span<const glm::vec3> radiance) const;

private:
    std::vector<std::uint32_t> receivers_;
    std::vector<glm::vec3> weights_; ///< [receivers] weights of red, green and blue in the mean
};

/// Returns the luminance (Rec. 709) that `Picture::suns` add to `LightMeter::luminance`, from rays towards
/// the suns at visible surfaces; 0 if the model covers no pixel. Suns add nothing to surfaces of a medium.
/// `scene` must be built from `*picture.scene`.
float sun_luminance(const Picture& picture, const TraceScene& scene);

/// Returns the exposure, a factor on radiance, that maps `luminance` to 0.22, a little brighter than middle
/// grey (0.18); 1 if `luminance` is not greater than 0.
float exposure_for(float luminance);

} // namespace prt
