#pragma once

// OpenGL contexts without a window.

#include <memory>
#include <string>

namespace prt {

/// Devices that a context may use.
enum class GlDevice {
    hardware, ///< only GPUs; software renderers such as Mesa's llvmpipe are excluded
    any,      ///< a GPU if there is one, otherwise a software renderer
};

/// An OpenGL 4.5 core context without a visible window. EGL creates the context without a display: on a GPU,
/// otherwise (only for GlDevice::any) on Mesa's surfaceless platform or on a software device. If EGL fails or
/// is missing, GLFW (if the library is built with it) creates a hidden window. GLFW needs a display, and the
/// main thread must then create and destroy the context. A context can be current on one thread at a time.
class GlContext {
public:
    /// Creates a context and makes it current on this thread. Returns null on failure; this thread may then
    /// have no current context. If `why` is not null, a failure sets `*why` to one line that lists the
    /// attempts and their errors.
    static std::unique_ptr<GlContext> create(GlDevice device, std::string* why = nullptr);
    /// Destroys the context. If the context is current on this thread, no context is current afterwards. The
    /// destructor of a GLFW context also releases any other GLFW context that is current on this thread.
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Returns the name of the renderer, as the driver reports it (GL_RENDERER).
    const std::string& renderer() const { return renderer_; }
    /// Makes the context current on this thread. Call this before drawing if other code may have made another
    /// context current. Throws `Error` if the driver refuses, for example after the GPU was lost.
    void make_current() const;

private:
    GlContext() = default;
    std::unique_ptr<class GlPlatform> platform_;
    std::string renderer_;
};

} // namespace prt
