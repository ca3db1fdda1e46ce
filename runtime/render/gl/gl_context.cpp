// Finds an OpenGL 4.5 context: by EGL, else by a hidden GLFW window.

#include "prt/gl/gl_context.h"

#include "prt/core/error.h"
#include "runtime/render/gl/gl_platform.h"

#include <epoxy/gl.h>

namespace prt {

bool is_software_renderer(const std::string& renderer) {
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer", "SWR"})
        if (renderer.find(name) != std::string::npos)
            return true;
    return false;
}

std::unique_ptr<GlContext> GlContext::create(GlDevice device, std::string* why) {
    std::string tried;
    std::unique_ptr<GlPlatform> platform;
#ifdef PRT_HAS_EGL
    platform = make_egl_platform(device, tried);
#endif
#ifdef PRT_HAS_GLFW
    if (!platform)
        platform = make_glfw_platform(device, tried);
#endif
    if (!platform) {
        if (why)
            *why = tried.empty() ? "built without EGL and without GLFW" : tried;
        return nullptr;
    }
    std::unique_ptr<GlContext> context(new GlContext);
    context->platform_ = std::move(platform);
    context->renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return context;
}

GlContext::~GlContext() = default;

void GlContext::make_current() const {
    if (!platform_->make_current())
        throw Error("the OpenGL context on " + renderer_ + " was lost");
}

} // namespace prt
