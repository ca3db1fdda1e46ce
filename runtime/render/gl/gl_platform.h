#pragma once

// Ways to get an OpenGL context without anything on a screen. Private: GlContext chooses.

#include "prt/gl_context.h"

#include <memory>
#include <string>

namespace prt {

/// A context.
class GlPlatform {
public:
    virtual ~GlPlatform() = default;
    /// On this thread; whether it could be made so.
    virtual bool make_current() = 0;
};

/// Whether an OpenGL renderer of that name is software.
bool is_software_renderer(const std::string& renderer);

/// Through EGL: a hardware device by enumeration, else Mesa's surfaceless platform, else a software device.
/// Null where there is none; what was tried is appended to `tried`.
std::unique_ptr<GlPlatform> make_egl_platform(GlDevice device, std::string& tried);

/// Through a hidden window of GLFW, for systems without EGL.
std::unique_ptr<GlPlatform> make_glfw_platform(GlDevice device, std::string& tried);

} // namespace prt
