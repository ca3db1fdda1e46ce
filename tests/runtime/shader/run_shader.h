#pragma once

// Runs the vertex shader of a model in the current context, and reads back its result. It calls only
// functions of OpenGL ES 3.0, so that one test serves both kinds of context.

#include "prt/core/clustered_transfer.h"
#include "prt/shader/shader_source.h"

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

/// True if the device of the current context filters textures, divides and computes roots exactly as C++
/// does: Mesa's software rasteriser does.
bool device_is_exact();
/// Tolerance of radiance against C++. GLSL allows errors of 2.5 units for divisions and of 2 units for
/// inverse roots; with small sums of weights, where few probes see a position, they are amplified a hundred
/// times: 7e-5 on an NVIDIA H200.
float rounding_tolerance();
/// Tolerance of filtered textures. OpenGL allows filter weights of 8 bits: on each of three axes the error is
/// 1/512 of the difference between neighbours, which is up to four times the mean in random volumes.
float filter_tolerance();

/// A shader object. A test in which it does not compile fails.
GLuint compiled(GLenum stage, const std::string& source);

/// Links and uses a program: a vertex shader that writes `radiance`, and a fragment shader that outputs it.
/// The test fails if it does not link.
GLuint linked_program(const std::string& vertex_shader, ShaderLanguage language);

/// Nothing is drawn, but without a window there is no framebuffer unless the test creates one.
void bind_small_framebuffer();

template <class T>
void bind_buffer(GLenum target, GLuint binding, const std::vector<T>& values) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_STATIC_DRAW);
    glBindBufferBase(target, binding, name);
}

/// Origin of the positions of predictors.
inline constexpr glm::vec3 kSceneOrigin{3, -1, 2};

/// Returns the `radiance` that a vertex shader writes for every receiver, given these constants; all other
/// inputs must be bound.
std::vector<glm::vec3> radiance_of_vertices(const ClusteredTransfer& transfer,
                                            const std::string& vertex_shader,
                                            const std::vector<glm::vec4>& constants, ShaderLanguage language,
                                            ConstantSource source);

/// Exit radiance of every receiver by relight_shader.
std::vector<glm::vec3> radiance_of_shader(const ClusteredTransfer& transfer, const Lighting& lighting,
                                          ShaderLanguage language, ConstantSource source);

} // namespace prt::test
