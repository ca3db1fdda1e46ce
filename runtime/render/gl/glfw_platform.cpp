// Creates contexts by a hidden GLFW window, for systems without EGL.

#include "runtime/render/gl/gl_platform.h"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace prt {
namespace {

class GlfwPlatform final : public GlPlatform {
public:
    explicit GlfwPlatform(GLFWwindow* window) : window_(window) {}
    ~GlfwPlatform() override {
        glfwMakeContextCurrent(nullptr);
        glfwDestroyWindow(window_);
    }
    bool make_current() override {
        glfwMakeContextCurrent(window_);
        return glfwGetCurrentContext() == window_;
    }

private:
    GLFWwindow* window_;
};

} // namespace

std::unique_ptr<GlPlatform> make_glfw_platform(GlDevice device, std::string& tried) {
    const auto failed = [&](const char* why) {
        tried += std::string(tried.empty() ? "" : ", ") + "a hidden window: " + why;
        return nullptr;
    };
    // GLFW remains initialised, because the program may have other windows.
    if (!glfwInit())
        return failed("no display");
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* window = glfwCreateWindow(16, 16, "prtkit", nullptr, nullptr);
    glfwDefaultWindowHints();
    if (!window)
        return failed("no OpenGL 4.5");
    glfwMakeContextCurrent(window);
    auto platform = std::make_unique<GlfwPlatform>(window);
    if (device == GlDevice::hardware &&
        is_software_renderer(reinterpret_cast<const char*>(glGetString(GL_RENDERER))))
        return failed("only software rendering");
    return platform;
}

} // namespace prt
