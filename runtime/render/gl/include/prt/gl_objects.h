#pragma once

// OpenGL objects that delete themselves, and programs from the shaders of prtkit. A context must be current.

#include "prt/support/error.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace prt {

/// Kind of an OpenGL object, which determines how it is deleted.
enum class GlKind { buffer, texture, framebuffer, vertex_array, program };

/// Owns an OpenGL name and deletes it.
class GlObject {
public:
    GlObject() = default;
    GlObject(GlKind kind, std::uint32_t name) : kind_(kind), name_(name) {}
    GlObject(GlObject&& other) noexcept : kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(kind_, other.kind_);
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject();

    std::uint32_t name() const { return name_; }

private:
    GlKind kind_ = GlKind::buffer;
    std::uint32_t name_ = 0;
};

/// Creates an immutable buffer with `bytes`. Throws `Error` if GPU memory runs out.
GlObject make_buffer(std::span<const std::byte> bytes);
template <class T>
GlObject make_buffer(std::span<const T> values) {
    return make_buffer(std::as_bytes(values));
}

/// Creates an immutable buffer that shaders write, of at least one word.
GlObject make_buffer_of(std::size_t bytes);
/// Reads data that shaders wrote from the start of `buffer` into `to`. Throws the errors of `check_gl(what)`.
void read_buffer(const GlObject& buffer, std::span<std::byte> to, const char* what);
template <class T>
void read_buffer(const GlObject& buffer, std::span<T> to, const char* what) {
    read_buffer(buffer, std::as_writable_bytes(to), what);
}
/// Binds `buffer` to storage block `binding`.
void bind_storage(std::uint32_t binding, const GlObject& buffer);

/// Creates a vertex array object without attributes.
GlObject make_vertex_array();
/// Creates a framebuffer object without attachments.
GlObject make_framebuffer();

/// Builds a program from the files `vertex` and `fragment` of shaders/, with the lines of `defines` before
/// each. Empty `fragment`: the program draws nothing. `captured`: an output of the vertex shader for
/// transform feedback. Throws `Error` with the compiler's message if compilation or linking fails.
GlObject make_program(const std::string& vertex, const std::string& fragment, const std::string& defines = "",
                      const char* captured = nullptr);

/// Builds a compute program from a file of shaders/.
GlObject make_compute_program(const std::string& compute, const std::string& defines = "");

/// Returns the location of the uniform `name`. Returns -1 if the program does not have it; OpenGL ignores
/// values for that location.
int uniform(const GlObject& program, const char* name);
/// Sets the uniform `name`; does nothing if the program does not have it.
void set_uniform(const GlObject& program, const char* name, std::uint32_t value);
void set_uniform(const GlObject& program, const char* name, float value);

/// Thrown if GPU memory runs out; smaller batches of work may still fit.
struct GpuOutOfMemory : Error {
    using Error::Error;
};

/// Throws `Error` if OpenGL has recorded an error, and `GpuOutOfMemory` if memory ran out. `what` names the
/// failed work in the message.
void check_gl(const char* what);

} // namespace prt
