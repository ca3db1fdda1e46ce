#pragma once

// Renders a `Picture` on the CPU by rays from the camera.

#include "bake/scene/trace_scene.h"
#include "prt/render/picture.h"

namespace prt {

/// Settings of `render_rays`.
struct RayPictureOptions {
    /// Number of shadow rays per pixel and sun, at least 1, spread over the disc of the sun. More rays make
    /// penumbrae smoother. The number is rounded up to a multiple of the samples of a pixel
    /// (Picture::samples²). A sun with half angle 0 gets one ray per sample.
    int sun_rays = 32;
    int threads = 0; ///< number of CPU threads; 0: all hardware threads
};

/// Renders `picture` and returns linear Rec. 709 radiance, one pixel per sample, with the top row first:
/// [height · samples][width · samples], with the sizes of `picture`. The caller averages the samples of a
/// pixel. The irradiance of a sun depends on the interpolated normal, and is zero on the side of a triangle
/// that faces away from the sun. Cut-outs, blended surfaces and glass let sun light pass; thin sheets also
/// transmit the sun light of their other side diffusely. Surfaces whose material is `solid` in `scene`
/// (TraceSceneOptions::solid) get no sun light, because a medium inside spreads it. `scene` must be built
/// from `*picture.scene`; the light of suns uses the textures of `scene`, all other light those of `picture`.
/// Throws the errors of TraceScene::rays.
Image render_rays(const Picture& picture, const TraceScene& scene, const RayPictureOptions& options = {});

} // namespace prt
