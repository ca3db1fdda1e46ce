#pragma once

// Platforms that create an OpenGL context without a visible window. Private: used by GlContext.

#include "prt/gl/gl_context.h"

#include <memory>
#include <string>

namespace prt {

/// An OpenGL context of a platform.
class GlPlatform {
public:
    virtual ~GlPlatform() = default;
    /// Makes the context current on this thread. Returns whether this succeeded.
    virtual bool make_current() = 0;
};

/// Returns whether the OpenGL renderer of that name is a software rasteriser.
bool is_software_renderer(const std::string& renderer);

/// Creates a context by EGL: a hardware device by enumeration, else Mesa's surfaceless platform, else a
/// software device. Returns null on failure; the attempts are appended to `tried`.
std::unique_ptr<GlPlatform> make_egl_platform(GlDevice device, std::string& tried);

/// Creates a context by a hidden GLFW window, for systems without EGL. Returns null on failure.
std::unique_ptr<GlPlatform> make_glfw_platform(GlDevice device, std::string& tried);

} // namespace prt
