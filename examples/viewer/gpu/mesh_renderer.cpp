// Draws colored meshes with OpenGL.

#include "gpu/mesh_renderer.h"

#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

namespace viewer {
namespace {

void attach(GLuint array, GLuint location, const prt::GlObject& buffer, GLint components) {
    glVertexArrayVertexBuffer(array, location, buffer.name(), 0,
                              static_cast<GLsizei>(sizeof(float)) * components);
    glEnableVertexArrayAttrib(array, location);
    glVertexArrayAttribFormat(array, location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, location, location);
}

} // namespace

MeshRenderer::MeshRenderer() : program_(prt::make_program("viewer_color.vert", "viewer_color.frag")) {}

void MeshRenderer::draw(const ColoredMesh& mesh, const glm::mat4& view_projection,
                        std::uint32_t framebuffer) const {
    const prt::GlObject positions = prt::make_buffer(std::span<const glm::vec3>(mesh.positions)),
                        colors = prt::make_buffer(std::span<const glm::vec4>(mesh.colors)),
                        indices = prt::make_buffer(std::span<const glm::uvec3>(mesh.triangles));
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    const prt::GlObject array(prt::GlKind::vertex_array, name);
    attach(name, PRT_LOCATION_POSITION, positions, 3);
    attach(name, PRT_LOCATION_COLOR, colors, 4);
    glVertexArrayElementBuffer(name, indices.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glUseProgram(program_.name());
    glUniformMatrix4fv(prt::uniform(program_, "view_projection"), 1, GL_FALSE,
                       glm::value_ptr(view_projection));
    glUniform4f(prt::uniform(program_, "tint"), 1, 1, 1, 1);
    glBindVertexArray(name);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * mesh.triangles.size()), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_DEPTH_TEST);
}

} // namespace viewer
