#pragma once

#include "prt/gl_context.h"
#include "prt/picture.h"

namespace prt {

/// Draws `picture` with OpenGL: linear radiance, [height · samples][width · samples]. Opaque and cut-out
/// surfaces use the depth buffer; blended primitives are drawn last, far ones first. Suns are
/// shadowed by maps (prt/sun_shadows.h): `picture.textures` are then those of all needs. Throws `Error` when
/// the picture is larger than the device can draw, has more than kMostShadowedSuns, or memory runs out.
Image render_gl(const Picture& picture, const GlContext& context);

} // namespace prt
