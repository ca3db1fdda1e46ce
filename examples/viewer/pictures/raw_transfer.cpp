// Computes exit radiance from raw transfer with a compute shader.

#include "pictures/raw_transfer.h"

#include "prt/shader/shader_source.h"
#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>
#include <glm/vec4.hpp>

#include <algorithm>
#include <vector>

namespace viewer {
namespace {

prt::GlObject make_program(const prt::Transfer& transfer) {
    return prt::make_compute_program("viewer_exit_radiance.comp", prt::term_defines(transfer.layout));
}

} // namespace

RawTransfer::RawTransfer(const prt::Transfer& transfer, std::size_t max_receivers)
    : layout_(transfer.layout), receivers_(transfer.receivers()),
      stride_(transfer.dimension() * sizeof(float)), max_receivers_(max_receivers),
      vectors_(prt::make_buffer(std::span<const float>(transfer.vectors))),
      light_(prt::make_buffer(std::span<const glm::vec4>(std::vector<glm::vec4>(layout_.columns())))),
      radiance_(prt::make_buffer(std::span<const glm::vec3>(std::vector<glm::vec3>(receivers_)))),
      program_(make_program(transfer)) {}

void RawTransfer::set_light(const prt::Lighting& lighting) {
    std::vector<glm::vec4> coefficients;
    for (const glm::vec3& color : prt::light_columns(layout_, lighting))
        coefficients.emplace_back(color, 0);
    glNamedBufferSubData(light_.name(), 0, static_cast<GLsizeiptr>(coefficients.size() * sizeof(glm::vec4)),
                         coefficients.data());
    // The storage buffer is bound in ranges, because a device may limit it to 128 MB. Ranges of a multiple of
    // 256 receivers keep every alignment.
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const std::size_t piece = std::max<std::size_t>(
        256, std::min<std::size_t>(static_cast<std::size_t>(most) / stride_, max_receivers_) / 256 * 256);
    glUseProgram(program_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_LIGHT, light_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_RAW_RADIANCE, radiance_.name());
    for (std::size_t first = 0; first < receivers_; first += piece) {
        const std::size_t count = std::min(piece, receivers_ - first);
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_MATRIX, vectors_.name(),
                          static_cast<GLintptr>(first * stride_), static_cast<GLsizeiptr>(count * stride_));
        glUniform1ui(prt::uniform(program_, "receivers"), static_cast<GLuint>(count));
        glUniform1ui(prt::uniform(program_, "first"), static_cast<GLuint>(first));
        glDispatchCompute(static_cast<GLuint>((count + 63) / 64), 1, 1);
    }
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

} // namespace viewer
