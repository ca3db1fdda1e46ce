#pragma once

// Automatic exposure: measures the light that comes from the model and, like a spot meter, ignores the sky
// behind it.

#include "prt/picture.h"
#include "prt/trace_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// The receivers that the camera of a picture sees, sampled on a coarse grid.
class LightMeter {
public:
    /// Casts at most 48 x 48 rays. Uses all of `picture` except its radiance, transfer and light, and keeps
    /// no reference to it. `ray_scene` was built from `*picture.scene`.
    LightMeter(const Picture& picture, const RayScene& ray_scene);

    /// Visible receivers, each once; for a picture with lightmaps the texels of its layout.
    std::span<const std::uint32_t> receivers() const { return receivers_; }

    /// Mean luminance (Rec. 709) of exit radiance times base color over the pixels that the model covers; 0
    /// if the model is not visible. `radiance` [receivers()]: exit radiance for albedo 1.
    float luminance(std::span<const glm::vec3> radiance) const;

private:
    std::vector<std::uint32_t> receivers_;
    std::vector<glm::vec3> weights_; ///< [receivers] weights of red, green and blue in the mean
};

/// Luminance that the suns of `picture` add to `LightMeter::luminance`, computed by rays towards the suns.
/// `scene` as for `render_rays`.
float sun_luminance(const Picture& picture, const TraceScene& scene);

/// Returns the factor on radiance that maps `luminance` to 0.22.
float exposure_for(float luminance);

} // namespace prt
