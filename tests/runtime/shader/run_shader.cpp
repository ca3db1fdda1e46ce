// Runs vertex shaders with transform feedback.

#include "run_shader.h"

#include "prt/core/cluster_lighting.h"
#include "shared_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace prt::test {
namespace {

/// `values` in rows of kConstantTextureWidth texels, the last filled up.
template <class T>
void bind_texture(GLuint unit, GLenum internal, GLenum format, GLenum type, std::vector<T> values) {
    const std::size_t width = kConstantTextureWidth, height = (values.size() + width - 1) / width;
    values.resize(width * height);
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), static_cast<GLsizei>(width),
                 static_cast<GLsizei>(height), 0, format, type, values.data());
}

void bind_constants(GLuint program, ConstantSource source, const std::vector<glm::vec4>& constants,
                    const std::vector<ClusterLayout>& layouts) {
    switch (source) {
    case ConstantSource::buffer:
        bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_CONSTANTS, constants);
        bind_buffer(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_CLUSTERS, layouts);
        return;
    case ConstantSource::block:
        glUniformBlockBinding(program, glGetUniformBlockIndex(program, "PrtConstants"),
                              PRT_BINDING_CONSTANTS);
        if (const GLuint table = glGetUniformBlockIndex(program, "PrtClusters"); table != GL_INVALID_INDEX)
            glUniformBlockBinding(program, table, PRT_BINDING_CLUSTERS);
        bind_buffer(GL_UNIFORM_BUFFER, PRT_BINDING_CONSTANTS, constants);
        bind_buffer(GL_UNIFORM_BUFFER, PRT_BINDING_CLUSTERS, layouts);
        return;
    case ConstantSource::texture:
        bind_texture(PRT_BINDING_CONSTANTS, GL_RGBA32F, GL_RGBA, GL_FLOAT, constants);
        bind_texture(PRT_BINDING_CLUSTERS, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, layouts);
        glUniform1i(glGetUniformLocation(program, "prt_constants"), PRT_BINDING_CONSTANTS);
        glUniform1i(glGetUniformLocation(program, "prt_clusters"), PRT_BINDING_CLUSTERS);
        return;
    }
}

void bind_receivers(const ClusteredReceivers& receivers) {
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(receivers.weights.size()), receivers.weights.data(),
                 GL_STATIC_DRAW);
    const auto stride = static_cast<GLsizei>(receivers.stride());
    const bool packed = receivers.format == WeightFormat::packed;
    const int vectors = packed ? (receivers.words + 3) / 4 : receivers.components / 4;
    for (int v = 0; v < vectors; ++v) {
        const auto location = static_cast<GLuint>(PRT_LOCATION_WEIGHTS + v);
        const auto* offset = reinterpret_cast<const void*>(16 * static_cast<std::size_t>(v));
        glEnableVertexAttribArray(location);
        if (packed)
            glVertexAttribIPointer(location, std::min(4, receivers.words - 4 * v), GL_UNSIGNED_INT, stride,
                                   offset);
        else
            glVertexAttribPointer(location, 4, GL_FLOAT, GL_FALSE, stride, offset);
    }
    if (packed)
        return;
    glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(receivers.clusters.size() * 2),
                 receivers.clusters.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(PRT_LOCATION_CLUSTER);
    glVertexAttribIPointer(PRT_LOCATION_CLUSTER, 1, GL_UNSIGNED_SHORT, 2, nullptr);
}

/// Binds the attributes of predictors: normals, and positions in the file's world space.
void bind_predictors(const ClusteredTransfer& transfer, const glm::vec3& scene_origin) {
    const std::size_t rows = transfer.bases.predictor_rows();
    for (std::size_t g = 0; g < transfer.bases.predictors.size(); ++g) {
        const Predictor& predictor = transfer.bases.predictors[g];
        const bool is_normal = predictor.kind == PredictorKind::normal;
        std::vector<glm::vec3> vectors;
        for (std::size_t p = 0; p < transfer.receivers.size(); ++p) {
            const float* x = &transfer.receivers.predictors[p * rows + 3 * g];
            vectors.push_back(glm::vec3(x[0], x[1], x[2]) +
                              (is_normal ? glm::vec3(0) : predictor.origin + scene_origin));
        }
        GLuint buffer = 0;
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vectors.size() * sizeof(glm::vec3)),
                     vectors.data(), GL_STATIC_DRAW);
        const GLuint location = is_normal ? PRT_LOCATION_NORMAL : PRT_LOCATION_POSITION;
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    }
}

} // namespace

void bind_small_framebuffer() {
    GLuint framebuffer = 0, color = 0;
    glGenRenderbuffers(1, &color);
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 1, 1);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
}

EsContext::EsContext() {
    display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
        return;
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display_, wanted, &config, 1, &count);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    context_ = eglCreateContext(display_, count > 0 ? config : nullptr, EGL_NO_CONTEXT, version);
    current_ =
        context_ != EGL_NO_CONTEXT && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

EsContext::~EsContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT)
        eglDestroyContext(display_, context_);
    eglTerminate(display_);
    eglBindAPI(EGL_OPENGL_API);
}

bool device_is_exact() {
    return std::strstr(reinterpret_cast<const char*>(glGetString(GL_RENDERER)), "llvmpipe") != nullptr;
}

float rounding_tolerance() {
    return device_is_exact() ? 1e-5f : 1e-4f;
}

float filter_tolerance() {
    return device_is_exact() ? 1e-2f : 3 * 4 / 512.0f;
}

GLuint compiled(GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    char log[2000] = {};
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    EXPECT_TRUE(ok) << log;
    return shader;
}

std::vector<glm::vec3> radiance_of_shader(const ClusteredTransfer& transfer, const Lighting& lighting,
                                          ShaderLanguage language, ConstantSource source) {
    const ClusterLighting relighter(transfer);
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(lighting, constants);
    return radiance_of_vertices(transfer, relight_shader(transfer, source, language, kSceneOrigin), constants,
                                language, source);
}

GLuint linked_program(const std::string& vertex_shader, ShaderLanguage language) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, vertex_shader));
    const std::string header = language == ShaderLanguage::essl300
                                   ? "#version 300 es\nprecision highp float;\n"
                               : language == ShaderLanguage::glsl330 ? "#version 330 core\n"
                                                                     : "#version 450 core\n";
    glAttachShader(
        program, compiled(GL_FRAGMENT_SHADER,
                          header + "in vec3 radiance; out vec4 c; void main() { c = vec4(radiance, 1.0); }"));
    const char* captured = "radiance";
    glTransformFeedbackVaryings(program, 1, &captured, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[2000] = {};
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    EXPECT_TRUE(linked) << log;
    glUseProgram(program);
    return program;
}

std::vector<glm::vec3> radiance_of_vertices(const ClusteredTransfer& transfer,
                                            const std::string& vertex_shader,
                                            const std::vector<glm::vec4>& constants, ShaderLanguage language,
                                            ConstantSource source) {
    const GLuint program = linked_program(vertex_shader, language);
    GLuint vertex_array = 0, output = 0;
    glGenVertexArrays(1, &vertex_array);
    glBindVertexArray(vertex_array);
    bind_receivers(transfer.receivers);
    bind_predictors(transfer, kSceneOrigin);
    bind_constants(program, source, constants, cluster_layouts(transfer.bases));
    bind_small_framebuffer();
    const std::size_t count = transfer.receivers.size(), bytes = count * sizeof(glm::vec3);
    glGenBuffers(1, &output);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, output);
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STATIC_READ);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    std::vector<glm::vec3> radiance(count, glm::vec3(-1));
    if (const void* data = glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, static_cast<GLsizeiptr>(bytes),
                                            GL_MAP_READ_BIT))
        std::memcpy(radiance.data(), data, bytes);
    return radiance;
}

} // namespace prt::test
