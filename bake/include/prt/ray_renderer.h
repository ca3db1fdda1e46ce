#pragma once

#include "prt/picture.h"
#include "prt/trace_scene.h"

namespace prt {

struct RayPictureOptions {
    /// For each pixel and sun, over its disc: what penumbrae are smooth by. At least one for each sample.
    int sun_rays = 32;
    int threads = 0; ///< 0: all
};

/// Draws `picture` with primary rays: linear radiance, [height · samples][width · samples]. Suns light what
/// they meet by the normals of its corners, but nothing that is turned away from them, through what lets
/// light through and through thin sheets; not what is `solid` in `scene`, whose light comes out of its
/// inside. `scene` was made of `*picture.scene`, with textures where suns shall shine through cut-outs.
Image render_rays(const Picture& picture, const TraceScene& scene, const RayPictureOptions& options = {});

} // namespace prt
