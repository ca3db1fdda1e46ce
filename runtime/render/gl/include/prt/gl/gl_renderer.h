#pragma once

// Renders pictures with OpenGL.

#include "prt/gl/gl_context.h"
#include "prt/render/picture.h"

namespace prt {

/// Draws `picture` with OpenGL and returns linear Rec. 709 radiance, one pixel per sample:
/// [height · samples][width · samples], rows from the top. Makes `context` current on this thread. Draws
/// opaque and cut-out surfaces with a depth buffer, then blended primitives from far to near. If
/// `picture.textured` is false, draws all surfaces as opaque. Does not restore the state of OpenGL. Adds
/// `picture.suns` with shadow maps (runtime/render/gl/sun_shadows.h); `picture.textures` must then be empty,
/// or loaded with TextureNeeds::all. Throws `Error` if the picture or a texture is larger than the device
/// supports, if the picture has more than kMaxShadowedSuns suns, if GPU memory runs out, if the driver cannot
/// build a program, or if the context is lost. Also throws the errors of `camera_frame`, and those of
/// GlTransfer and GlRelitTextures for `picture.in_shader`.
Image render_gl(const Picture& picture, const GlContext& context);

} // namespace prt
