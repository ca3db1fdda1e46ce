// Creates contexts by EGL, which needs no display: enumerated devices, then Mesa's surfaceless platform.

#include "runtime/render/gl/gl_platform.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

namespace prt {
namespace {

bool has_extension(const char* list, std::string_view name) {
    if (!list)
        return false;
    std::string padded = " " + std::string(list) + " ";
    return padded.find(" " + std::string(name) + " ") != std::string::npos;
}

std::vector<EGLDeviceEXT> enumerate_devices() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has_extension(client, "EGL_EXT_platform_device") ||
        !has_extension(client, "EGL_EXT_device_enumeration"))
        return {};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0)
        return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    eglQueryDevicesEXT(count, devices.data(), &count);
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

/// A reference-counted display: contexts of one device share it, and terminating it would terminate all of
/// them.
class OpenDisplay {
public:
    /// The display is null if it cannot be opened.
    OpenDisplay(EGLenum platform, void* native)
        : display_(eglGetPlatformDisplayEXT(platform, native, nullptr)) {
        const std::lock_guard lock(mutex());
        if (display_ != EGL_NO_DISPLAY && !eglInitialize(display_, nullptr, nullptr))
            display_ = EGL_NO_DISPLAY;
        if (display_ != EGL_NO_DISPLAY)
            ++users()[display_];
    }
    OpenDisplay(OpenDisplay&& other) noexcept : display_(std::exchange(other.display_, EGL_NO_DISPLAY)) {}
    OpenDisplay& operator=(OpenDisplay&&) = delete;
    ~OpenDisplay() {
        const std::lock_guard lock(mutex());
        if (display_ != EGL_NO_DISPLAY && --users()[display_] == 0)
            eglTerminate(display_);
    }
    EGLDisplay get() const { return display_; }

private:
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    static std::map<EGLDisplay, int>& users() {
        static std::map<EGLDisplay, int> users;
        return users;
    }

    EGLDisplay display_;
};

class EglPlatform final : public GlPlatform {
public:
    EglPlatform(OpenDisplay display, EGLContext context) : display_(std::move(display)), context_(context) {}
    ~EglPlatform() override {
        if (eglGetCurrentContext() == context_)
            eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_.get(), context_);
    }
    bool make_current() override {
        return eglBindAPI(EGL_OPENGL_API) &&
               eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }

private:
    OpenDisplay display_;
    EGLContext context_;
};

std::unique_ptr<GlPlatform> on_display(EGLenum platform, void* native, const char* name, std::string& tried) {
    OpenDisplay opened(platform, native);
    const EGLDisplay display = opened.get();
    if (display == EGL_NO_DISPLAY) {
        tried += std::string(tried.empty() ? "" : ", ") + name + ": cannot be opened";
        return nullptr;
    }
    constexpr std::array<EGLint, 7> kAttributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                   4,
                                                   EGL_CONTEXT_MINOR_VERSION,
                                                   5,
                                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                   EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    constexpr std::array<EGLint, 5> kConfig = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                               EGL_OPENGL_BIT, EGL_NONE};
    const bool has_api = eglBindAPI(EGL_OPENGL_API);
    eglChooseConfig(display, kConfig.data(), &config, 1, &configs);
    const EGLContext context = has_api ? eglCreateContext(display, configs > 0 ? config : EGL_NO_CONFIG_KHR,
                                                          EGL_NO_CONTEXT, kAttributes.data())
                                       : EGL_NO_CONTEXT;
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        tried += std::string(tried.empty() ? "" : ", ") + name + ": no OpenGL 4.5";
        if (context != EGL_NO_CONTEXT)
            eglDestroyContext(display, context);
        return nullptr;
    }
    return std::make_unique<EglPlatform>(std::move(opened), context);
}

} // namespace

std::unique_ptr<GlPlatform> make_egl_platform(GlDevice device, std::string& tried) {
    const std::vector<EGLDeviceEXT> devices = enumerate_devices();
    for (EGLDeviceEXT candidate : devices) {
        if (has_extension(eglQueryDeviceStringEXT(candidate, EGL_EXTENSIONS), "EGL_MESA_device_software"))
            continue;
        auto platform = on_display(EGL_PLATFORM_DEVICE_EXT, candidate, "a GPU", tried);
        if (platform && !is_software_renderer(reinterpret_cast<const char*>(glGetString(GL_RENDERER))))
            return platform;
    }
    if (device == GlDevice::hardware)
        return nullptr;
    if (has_extension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless"))
        if (auto platform =
                on_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "surfaceless", tried))
            return platform;
    for (EGLDeviceEXT candidate : devices)
        if (auto platform = on_display(EGL_PLATFORM_DEVICE_EXT, candidate, "a software device", tried))
            return platform;
    if (tried.empty())
        tried = "EGL has no device";
    return nullptr;
}

} // namespace prt
