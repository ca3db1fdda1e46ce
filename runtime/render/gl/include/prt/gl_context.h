#pragma once

// OpenGL contexts without a window.

#include <memory>
#include <string>

namespace prt {

/// Devices that a context may use.
enum class GlDevice {
    hardware, ///< a GPU only; excludes Mesa's software rasterisers
    any,      ///< a GPU if available, else software
};

/// An OpenGL 4.5 core context without window or display, through EGL: a hardware device by enumeration
/// (EGL_EXT_platform_device), else Mesa's surfaceless platform, else a software device. Without EGL it uses a
/// hidden GLFW window. The context is current on the thread that created it, until another context becomes
/// current or it is destroyed.
class GlContext {
public:
    /// Creates a context and makes it current. Returns null if there is no such device; `why` then lists the
    /// attempts and their errors.
    static std::unique_ptr<GlContext> create(GlDevice device, std::string* why = nullptr);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    const std::string& renderer() const { return renderer_; } ///< name from the driver
    /// Makes the context current on this thread. Code that draws with a context calls this first, because a
    /// driver or another context may have changed the current one. Throws `Error` if the context is lost.
    void make_current() const;

private:
    GlContext() = default;
    std::unique_ptr<class GlPlatform> platform_;
    std::string renderer_;
};

} // namespace prt
