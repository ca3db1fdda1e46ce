#pragma once

// Renders pictures with OpenGL.

#include "prt/gl_context.h"
#include "prt/picture.h"

namespace prt {

/// Draws `picture` with OpenGL and returns linear Rec. 709 radiance, one pixel per sample:
/// [height · samples][width · samples], rows from the top. Makes `context` current on this thread. Draws
/// opaque and cut-out surfaces with a depth buffer, then blended primitives from far to near. Adds
/// `picture.suns` with shadow maps (prt/sun_shadows.h); `picture.textures` must then be loaded with
/// TextureNeeds::all. Throws `Error` if the picture is larger than the device supports, if it has more than
/// kMaxShadowedSuns suns, if GPU memory runs out, or if the context is lost.
Image render_gl(const Picture& picture, const GlContext& context);

} // namespace prt
