#pragma once

// OpenGL objects that delete themselves, and programs from the shaders of prtkit. An OpenGL 4.5 context must
// be current on the thread for all functions, and when an object is destroyed.

#include "prt/core/error.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace prt {

/// Kind of an OpenGL object, which determines the function that deletes it.
enum class GlKind { buffer, texture, framebuffer, vertex_array, program };

/// Owner of one OpenGL object, which the destructor deletes. Movable, not copyable.
class GlObject {
public:
    /// Owns no object.
    GlObject() = default;
    /// Takes ownership of the OpenGL object `name`; 0: no object.
    GlObject(GlKind kind, std::uint32_t name) : kind_(kind), name_(name) {}
    /// Takes the object of `other`, which then owns no object.
    GlObject(GlObject&& other) noexcept : kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}
    /// Exchanges the objects of both owners; `other` deletes the previous object later.
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(kind_, other.kind_);
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject();

    /// Returns the name (number) that OpenGL functions use for the object; 0 if there is no object.
    std::uint32_t name() const { return name_; }

private:
    GlKind kind_ = GlKind::buffer;
    std::uint32_t name_ = 0;
};

/// Creates a buffer of fixed size and fills it with a copy of `bytes`. If `bytes` is empty, the buffer
/// contains four zero bytes. `glNamedBufferSubData` can change the contents. Throws `GpuOutOfMemory` if GPU
/// memory runs out, and the other errors of `check_gl`.
GlObject make_buffer(std::span<const std::byte> bytes);
/// Creates a buffer of fixed size and fills it with a copy of `values`, like `make_buffer` for bytes.
template <class T>
GlObject make_buffer(std::span<const T> values) {
    return make_buffer(std::as_bytes(values));
}

/// Creates a buffer of `bytes` bytes, at least 4, with undefined contents. Shaders can write it; the CPU
/// cannot. Throws `GpuOutOfMemory` if GPU memory runs out, and the other errors of `check_gl`.
GlObject make_buffer_of(std::size_t bytes);
/// Copies the first `to.size()` bytes of `buffer` into `to`. If shaders wrote the buffer, the caller must
/// issue glMemoryBarrier before. The buffer must have at least `to.size()` bytes. Throws the errors of
/// `check_gl(what)`.
void read_buffer(const GlObject& buffer, std::span<std::byte> to, const char* what);
/// Copies the start of `buffer` into the values `to`, like `read_buffer` for bytes.
template <class T>
void read_buffer(const GlObject& buffer, std::span<T> to, const char* what) {
    read_buffer(buffer, std::as_writable_bytes(to), what);
}
/// Binds `buffer` to the shader storage block with number `binding`.
void bind_storage(std::uint32_t binding, const GlObject& buffer);

/// Creates a vertex array object without attributes.
GlObject make_vertex_array();
/// Creates a framebuffer object without attachments.
GlObject make_framebuffer();

/// Builds a program from two shaders of prtkit. `vertex` and `fragment`: names of files in shaders/, which
/// are embedded in the library, for example "scene.vert". `fragment` may be empty: the program then has only
/// a vertex shader, for transform feedback. `defines`: complete #define lines before the text of each shader.
/// `captured`: the output of the vertex shader that transform feedback records; null: no output. Throws
/// `Error` if a file does not exist, and, with the message of the driver, if compilation or linking fails.
GlObject make_program(const std::string& vertex, const std::string& fragment, const std::string& defines = "",
                      const char* captured = nullptr);

/// Builds a compute program. `compute`: name of a file in shaders/, which is embedded in the library.
/// `defines`: complete #define lines before its text. Throws the errors of `make_program`.
GlObject make_compute_program(const std::string& compute, const std::string& defines = "");

/// Returns the location of the uniform `name`; -1 if the program does not have this uniform. OpenGL ignores
/// values that are set for location -1.
int uniform(const GlObject& program, const char* name);
/// Sets the `uint` uniform `name`. Does nothing if the program does not have this uniform.
void set_uniform(const GlObject& program, const char* name, std::uint32_t value);
/// Sets the `float` uniform `name`. Does nothing if the program does not have this uniform.
void set_uniform(const GlObject& program, const char* name, float value);

/// Error for GPU memory that ran out. Smaller batches of work may still fit.
struct GpuOutOfMemory : Error {
    using Error::Error;
};

/// Reads and clears one error flag of OpenGL (glGetError), which an earlier OpenGL call may have set. Throws
/// `GpuOutOfMemory` if GPU memory ran out, and `Error` for any other error. `what`: the work that failed, a
/// noun for the message, for example "a texture".
void check_gl(const char* what);

} // namespace prt
