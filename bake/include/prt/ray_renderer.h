#pragma once

#include "prt/picture.h"
#include "prt/ray_scene.h"

namespace prt {

/// Draws `picture` with primary rays: linear radiance, [height · samples][width · samples]. `ray_scene` was
/// built from `*picture.scene`. `threads` 0: all.
Image render_rays(const Picture& picture, const RayScene& ray_scene, int threads = 0);

} // namespace prt
