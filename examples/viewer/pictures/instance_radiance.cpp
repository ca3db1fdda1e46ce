// Computes the exit radiance of instances by transform feedback.

#include "pictures/instance_radiance.h"

#include "prt/shader/shader_source.h"
#include "runtime/core/support/stopwatch.h"
#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace viewer {
namespace {

constexpr GLuint kTableBinding = 10;
constexpr std::size_t kVertexBytes = 8; ///< four half floats
constexpr std::size_t kAlignment = 256; ///< maximum alignment of storage buffer ranges that a device may
                                        ///< require

} // namespace

std::size_t InstanceRadiance::Draw::bytes() const {
    return instances * vertices * kVertexBytes;
}

InstanceRadiance::InstanceRadiance(const prt::ClusteredTransfer& transfer, const prt::GlScene& scene,
                                   std::span<const prt::RelitInstance> computed,
                                   std::span<const MeshInstances> meshes)
    : transfer_(transfer), relighter_(transfer, computed), arrays_(scene.make_vertex_arrays()),
      table_(prt::make_buffer(std::span<const glm::vec4>(relighter_.table()))),
      program_(prt::make_program("viewer_lit_instances.vert", "", prt::instance_defines(transfer))),
      framebuffer_(prt::make_framebuffer()) {
    std::size_t end = 0;
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (const std::size_t array : meshes[m].vertex_arrays) {
            const prt::VertexArray& vertices = scene.scene().vertex_arrays[array];
            transfer_.attach(arrays_[array].name(), vertices.first_receiver);
            const Draw& draw =
                draws_.emplace_back(Draw{m, array, vertices.size(), meshes[m].first, meshes[m].count, end});
            end = (end + draw.bytes() + kAlignment - 1) / kAlignment * kAlignment;
        }
    radiance_ = prt::make_buffer_of(end);
    constants_.computed.resize(relighter_.size());
    constants_.buffer = prt::make_buffer(std::span<const glm::vec4>(constants_.computed));
    attach_table(arrays_);
    glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
    glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
}

/// Attaches the attributes that advance per instance.
void InstanceRadiance::attach_table(const prt::GlVertexArrays& arrays) const {
    for (const prt::GlObject& array : arrays) {
        glVertexArrayBindingDivisor(array.name(), kTableBinding, 1);
        for (const GLuint location : {GLuint{PRT_LOCATION_INSTANCE_0}, GLuint{PRT_LOCATION_INSTANCE_1}}) {
            const GLuint offset = location == PRT_LOCATION_INSTANCE_0 ? 0 : sizeof(glm::vec4);
            glEnableVertexArrayAttrib(array.name(), location);
            glVertexArrayAttribFormat(array.name(), location, 4, GL_FLOAT, GL_FALSE, offset);
            glVertexArrayAttribBinding(array.name(), location, kTableBinding);
        }
    }
}

void InstanceRadiance::set_light(const prt::Lighting& lighting) {
    const prt::Stopwatch stopwatch;
    relighter_.update(lighting, constants_.computed);
    constants_.seconds = stopwatch.seconds();
    glNamedBufferSubData(constants_.buffer.name(), 0,
                         static_cast<GLsizeiptr>(constants_.computed.size() * sizeof(glm::vec4)),
                         constants_.computed.data());
    glUseProgram(program_.name());
    transfer_.use();
    prt::bind_storage(PRT_BINDING_CONSTANTS, constants_.buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name()); // OpenGL requires a framebuffer, though nothing
                                                            // is drawn
    glEnable(GL_RASTERIZER_DISCARD);
    constexpr GLsizei kRowBytes = 2 * sizeof(glm::vec4); // row of the table
    for (const Draw& draw : draws_) {
        if (draw.bytes() == 0)
            continue;
        const GLuint array = arrays_[draw.vertex_array].name();
        glVertexArrayVertexBuffer(array, kTableBinding, table_.name(),
                                  static_cast<GLintptr>(draw.first_instance) * kRowBytes, kRowBytes);
        glBindVertexArray(array);
        bind(program_, draw);
        glDrawArraysInstanced(GL_POINTS, 0, static_cast<GLsizei>(draw.vertices),
                              static_cast<GLsizei>(draw.instances));
    }
    glDisable(GL_RASTERIZER_DISCARD);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    prt::check_gl("lighting instances");
}

void InstanceRadiance::use(const prt::GlObject& program, std::size_t mesh, std::size_t vertex_array) const {
    const auto draw = std::ranges::find_if(
        draws_, [&](const Draw& p) { return p.mesh == mesh && p.vertex_array == vertex_array; });
    bind(program, *draw);
}

void InstanceRadiance::bind(const prt::GlObject& program, const Draw& draw) const {
    prt::set_uniform(program, "instance_vertices", static_cast<std::uint32_t>(draw.vertices));
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_INSTANCE_RADIANCE, radiance_.name(),
                      static_cast<GLintptr>(draw.begin), static_cast<GLsizeiptr>(draw.bytes()));
}

std::size_t InstanceRadiance::bytes() const {
    return draws_.empty() ? 0 : draws_.back().begin + draws_.back().bytes();
}

std::size_t InstanceRadiance::bytes_of_constants() const {
    return constants_.computed.size() * sizeof(glm::vec4);
}

} // namespace viewer
