#pragma once

// Renders pictures with OpenGL.

#include "prt/gl_context.h"
#include "prt/picture.h"

namespace prt {

/// Draws `picture` with OpenGL: linear radiance, [height · samples][width · samples]. Opaque and cut-out
/// surfaces use the depth buffer; blended primitives are drawn last, from far to near. Suns use shadow maps
/// (prt/sun_shadows.h), which require `picture.textures` loaded with TextureNeeds::all. Throws `Error` if the
/// picture is larger than the device supports, has more than kMaxShadowedSuns suns, or memory runs out.
Image render_gl(const Picture& picture, const GlContext& context);

} // namespace prt
