#pragma once

// Automatic exposure: measures the light that comes from the model, as a spot meter does, and not the sky
// behind it.

#include "prt/picture.h"
#include "prt/trace_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Where the camera of a picture sees the model, on a coarse grid.
class LightMeter {
public:
    /// Casts at most 48 x 48 rays. Uses all of `picture` but its radiance, transfer and light; keeps nothing
    /// of it. `ray_scene` was built from `*picture.scene`.
    LightMeter(const Picture& picture, const RayScene& ray_scene);

    /// The receivers that it looks at, each once: of a picture with lightmaps the texels of their layout.
    std::span<const std::uint32_t> receivers() const { return receivers_; }

    /// Mean luminance (Rec. 709) of exit radiance times base color over what the model covers; 0 where it is
    /// not seen. `radiance` [receivers()]: exit radiance for albedo 1.
    float luminance(std::span<const glm::vec3> radiance) const;

private:
    std::vector<std::uint32_t> receivers_;
    std::vector<glm::vec3> weights_; ///< [receivers] of red, green and blue in the mean
};

/// What the suns of `picture` add to that luminance, by rays at them. `scene` as for `render_rays`.
float sun_luminance(const Picture& picture, const TraceScene& scene);

/// Factor on radiance that brings `luminance` to 0.22.
float exposure_for(float luminance);

} // namespace prt
