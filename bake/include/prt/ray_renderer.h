#pragma once

#include "prt/picture.h"
#include "prt/trace_scene.h"

namespace prt {

struct RayPictureOptions {
    /// Rays per pixel and sun over the sun's disc, which determine how smooth penumbrae are. At least one per
    /// sample.
    int sun_rays = 32;
    int threads = 0; ///< number of threads; 0: all
};

/// Draws `picture` with primary rays: linear radiance, [height · samples][width · samples]. Suns light
/// visible surfaces by interpolated normals, except on the far side of triangles that face away from the sun.
/// Their light passes surfaces that transmit rays, and thin sheets. Surfaces that are `solid` in `scene` get
/// no sun light, because their light comes out of the medium inside. `scene` was built from `*picture.scene`,
/// with textures if suns are to shine through cut-outs.
Image render_rays(const Picture& picture, const TraceScene& scene, const RayPictureOptions& options = {});

} // namespace prt
