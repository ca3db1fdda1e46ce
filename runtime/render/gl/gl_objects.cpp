// Creates OpenGL objects by direct state access (OpenGL 4.5), and programs from the embedded shaders.

#include "runtime/render/gl/gl_objects.h"

#include "prt/shader/shader_source.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace prt {
namespace {

GLuint compile(GLenum stage, const std::string& file, const std::string& defines) {
    const std::string source = shader_source(file, defines);
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return shader;
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    glDeleteShader(shader);
    throw Error("the driver cannot compile " + file + ": " + log.substr(0, static_cast<std::size_t>(length)));
}

void attach(const GlObject& program, GLenum stage, const std::string& file, const std::string& defines) {
    const GLuint shader = compile(stage, file, defines);
    glAttachShader(program.name(), shader);
    glDeleteShader(shader); // deleted when it is detached
}

void link(const GlObject& program, const std::string& files) {
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked)
        return;
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    throw Error("the driver cannot link " + files + ": " + log.substr(0, static_cast<std::size_t>(length)));
}

} // namespace

GlObject::~GlObject() {
    if (name_ == 0)
        return;
    switch (kind_) {
    case GlKind::buffer:
        glDeleteBuffers(1, &name_);
        break;
    case GlKind::texture:
        glDeleteTextures(1, &name_);
        break;
    case GlKind::framebuffer:
        glDeleteFramebuffers(1, &name_);
        break;
    case GlKind::vertex_array:
        glDeleteVertexArrays(1, &name_);
        break;
    case GlKind::program:
        glDeleteProgram(name_);
        break;
    }
}

GlObject make_buffer(std::span<const std::byte> bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlObject buffer(GlKind::buffer, name);
    constexpr std::byte kNothing[4] = {};
    if (bytes.empty()) // OpenGL does not support empty buffers
        bytes = kNothing;
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_DYNAMIC_STORAGE_BIT);
    check_gl("a buffer");
    return buffer;
}

GlObject make_buffer_of(std::size_t bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlObject buffer(GlKind::buffer, name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4)), nullptr, 0);
    check_gl("a buffer");
    return buffer;
}

void read_buffer(const GlObject& buffer, std::span<std::byte> to, const char* what) {
    glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(to.size()), to.data());
    check_gl(what);
}

void bind_storage(std::uint32_t binding, const GlObject& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
}

GlObject make_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return {GlKind::vertex_array, name};
}

GlObject make_framebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return {GlKind::framebuffer, name};
}

GlObject make_program(const std::string& vertex, const std::string& fragment, const std::string& defines,
                      const char* captured) {
    GlObject program(GlKind::program, glCreateProgram());
    attach(program, GL_VERTEX_SHADER, vertex, defines);
    if (!fragment.empty())
        attach(program, GL_FRAGMENT_SHADER, fragment, defines);
    if (captured)
        glTransformFeedbackVaryings(program.name(), 1, &captured, GL_INTERLEAVED_ATTRIBS);
    link(program, fragment.empty() ? vertex : vertex + " and " + fragment);
    return program;
}

GlObject make_compute_program(const std::string& compute, const std::string& defines) {
    GlObject program(GlKind::program, glCreateProgram());
    attach(program, GL_COMPUTE_SHADER, compute, defines);
    link(program, compute);
    return program;
}

int uniform(const GlObject& program, const char* name) {
    return glGetUniformLocation(program.name(), name);
}

void set_uniform(const GlObject& program, const char* name, std::uint32_t value) {
    glProgramUniform1ui(program.name(), uniform(program, name), value);
}

void set_uniform(const GlObject& program, const char* name, float value) {
    glProgramUniform1f(program.name(), uniform(program, name), value);
}

void check_gl(const char* what) {
    const GLenum error = glGetError();
    if (error == GL_OUT_OF_MEMORY)
        throw GpuOutOfMemory(std::string("the GPU does not have enough memory for ") + what);
    if (error == GL_CONTEXT_LOST)
        throw Error(std::string("the GPU was lost because its driver was reset (in ") + what + ")");
    if (error != GL_NO_ERROR)
        throw Error(std::string("OpenGL error ") + std::to_string(error) + " in " + what);
}

} // namespace prt
