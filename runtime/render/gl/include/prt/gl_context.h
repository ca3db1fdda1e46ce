#pragma once

#include <memory>
#include <string>

namespace prt {

enum class GlDevice {
    hardware, ///< a GPU only; Mesa's software rasterisers do not count
    any,      ///< a GPU where there is one, else software
};

/// An OpenGL 4.5 core context without window or display, through EGL: a hardware device by enumeration
/// (EGL_EXT_platform_device), else Mesa's surfaceless platform, else a software device; where EGL has none, a
/// hidden window of GLFW. Current on the thread that made it, until another is or it is destroyed.
class GlContext {
public:
    /// Null when there is no such device; `why` then says what was tried.
    static std::unique_ptr<GlContext> create(GlDevice device, std::string* why = nullptr);
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    const std::string& renderer() const { return renderer_; } ///< as the driver names it
    /// On this thread, where something else may have been: a driver's own work, or another context. What
    /// draws with a context does it. Throws `Error` where the context is lost.
    void make_current() const;

private:
    GlContext() = default;
    std::unique_ptr<class GlPlatform> platform_;
    std::string renderer_;
};

} // namespace prt
