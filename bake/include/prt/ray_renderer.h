#pragma once

#include "prt/picture.h"
#include "prt/trace_scene.h"

namespace prt {

/// Settings of `render_rays`.
struct RayPictureOptions {
    /// Number of rays per pixel and sun, spread over the sun's disc; more rays make penumbrae smoother. At
    /// least one ray per sample is traced.
    int sun_rays = 32;
    int threads = 0; ///< number of threads; 0: all
};

/// Draws `picture` with primary rays: linear radiance, [height · samples][width · samples]. Suns light
/// visible surfaces by interpolated normals, except on the far side of triangles that face away from the sun.
/// Sun light passes transparent surfaces and thin sheets. Surfaces that are `solid` in `scene` get no sun
/// light, because their light comes from the medium inside. `scene` must be built from `*picture.scene`, with
/// textures if suns shine through cut-outs.
Image render_rays(const Picture& picture, const TraceScene& scene, const RayPictureOptions& options = {});

} // namespace prt
