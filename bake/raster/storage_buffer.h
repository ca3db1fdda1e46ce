#pragma once

// Storage buffers of OpenGL.

#include "runtime/render/gl/gl_objects.h"

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace prt {

/// Creates a shader storage buffer of `values`. Throws `Error` with their name `what` if they exceed the
/// maximum size.
template <class T>
GlObject storage_buffer(const std::vector<T>& values, const char* what) {
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    if (static_cast<GLint64>(values.size() * sizeof(T)) > largest)
        throw Error(std::string("the scene is too large for this GPU: ") + what + " need " +
                    std::to_string(values.size() * sizeof(T) >> 20) + " MB, but a buffer is limited to " +
                    std::to_string(largest >> 20) + " MB");
    return make_buffer(std::as_bytes(std::span(values)));
}

} // namespace prt
