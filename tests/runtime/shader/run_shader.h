#pragma once

// Runs the vertex shader of a model in the context that is current, and reads back what it computes. Only
// what OpenGL ES 3.0 has is called, so that one test serves both kinds of context.

#include "prt/clustered_transfer.h"
#include "prt/shader_source.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace prt::test {

/// An OpenGL ES 3.0 context without a surface.
class EsContext {
public:
    EsContext();
    ~EsContext();
    EsContext(const EsContext&) = delete;
    EsContext& operator=(const EsContext&) = delete;
    bool current() const { return current_; }

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    bool current_ = false;
};

/// Whether the device of the current context filters textures, divides and takes roots as C++ does: Mesa's
/// software does.
bool device_is_exact();
/// Of radiance against C++. GLSL lets divisions and inverse roots be off by 2.5 and 2 units; by small sums of
/// weights, as where few probes see a place, they count a hundred times: 7e-5 on an NVIDIA H200.
float rounding_tolerance();
/// Of what textures filter. OpenGL lets shares of a texel have 8 bits: each of three axes is off by 1/512 of
/// how far neighbours differ, which is up to four times the mean in random volumes.
float filter_tolerance();

/// A shader object. A test in which it does not compile fails.
GLuint compiled(GLenum stage, const std::string& source);

/// A program in use, of a vertex shader that writes `radiance` and a fragment shader that shows it. A test in
/// which it does not link fails.
GLuint linked_program(const std::string& vertex_shader, ShaderLanguage language);

/// Nothing is drawn, but without a window there is no framebuffer unless we make one.
void bind_small_framebuffer();

template <class T>
void bind_buffer(GLenum target, GLuint binding, const std::vector<T>& values) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_STATIC_DRAW);
    glBindBufferBase(target, binding, name);
}

/// Where positions of guides are seen from.
inline constexpr glm::vec3 kSceneOrigin{3, -1, 2};

/// What a vertex shader writes as `radiance` for every receiver, from these constants; what else it reads is
/// bound.
std::vector<glm::vec3> radiance_of_vertices(const ClusteredTransfer& transfer,
                                            const std::string& vertex_shader,
                                            const std::vector<glm::vec4>& constants, ShaderLanguage language,
                                            ConstantSource source);

/// Exit radiance of every receiver by relight_shader.
std::vector<glm::vec3> radiance_of_shader(const ClusteredTransfer& transfer, const Lighting& lighting,
                                          ShaderLanguage language, ConstantSource source);

} // namespace prt::test
