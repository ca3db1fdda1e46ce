// Orthographic depth maps (S. Hill, "Hardware Accelerating Art Production", Gamasutra 2004) and depth peeling
// (C. Everitt, "Interactive Order-Independent Transparency", 2001).

#include "bake/raster/depth_maps.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace prt {
namespace {

/// Maximum number of peeled layers of blended surfaces; surfaces behind more layers are practically
/// invisible.
constexpr int kMaxLayers = 64;

GlObject make_map(GLenum target) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return {GlKind::texture, name};
}

} // namespace

DepthMaps::DepthMaps(const RasterScene& scene, const Bounds& bounds, int resolution, bool blends)
    : scene_(scene), resolution_(resolution), center_(0.5f * (bounds.low + bounds.high)),
      // The sphere is slightly enlarged, so that nothing is on its border.
      radius_(std::max(0.5f * glm::length(bounds.high - bounds.low) * 1.001f,
                       std::numeric_limits<float>::min())) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (resolution > largest)
        throw Error("depth maps with " + std::to_string(resolution) +
                    " texels per side exceed the limit of " + std::to_string(largest) +
                    " of this GPU; use a lower resolution");
    maps_ = make_map(GL_TEXTURE_2D_ARRAY);
    glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, resolution, resolution,
                       static_cast<GLsizei>(blends ? 1 : kMax));
    check_gl("the depth maps");
    target_ = make_framebuffer();
    glNamedFramebufferDrawBuffer(target_.name(), GL_NONE);
    program_ = make_program("bake_raster.vert", "bake_raster.frag", scene.defines());
    no_vertices_ = make_vertex_array();
    if (blends)
        make_layers();
}

void DepthMaps::make_layers() {
    Layers& layers = layers_.emplace();
    for (GlObject& depth : layers.depth) {
        depth = make_map(GL_TEXTURE_2D);
        glTextureStorage2D(depth.name(), 1, GL_DEPTH_COMPONENT32F, resolution_, resolution_);
    }
    layers.coverage = make_map(GL_TEXTURE_2D);
    glTextureStorage2D(layers.coverage.name(), 1, GL_R32F, resolution_, resolution_);
    check_gl("the depth layers");
    layers.target = make_framebuffer();
    glNamedFramebufferTexture(layers.target.name(), GL_COLOR_ATTACHMENT0, layers.coverage.name(), 0);
    layers.program =
        make_program("bake_raster.vert", "bake_raster.frag", scene_.defines() + "#define PRT_PEEL\n");
}

/// Transforms world space to the map of light from `direction`: [-1, 1]³, nearer to the light first.
glm::mat4 DepthMaps::map_matrix(const glm::vec3& direction) const {
    const glm::vec3 up = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    return glm::ortho(-radius_, radius_, -radius_, radius_, 0.0f, 2 * radius_) *
           glm::lookAt(center_ + radius_ * direction, center_, up);
}

GlObject DepthMaps::table(std::span<const glm::vec3> directions, int order) const {
    const glm::mat4 to_unit =
        glm::translate(glm::mat4(1), glm::vec3(0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.5f));
    std::vector<gpu::Direction> table(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        table[i].towards_light = glm::vec4(directions[i], 0);
        table[i].map_from_world = to_unit * map_matrix(directions[i]);
        std::array<double, PRT_MAX_COEFFICIENTS> basis{};
        evaluate_sh(order, glm::normalize(glm::dvec3(directions[i])), std::span<double>(basis));
        std::copy(basis.begin(), basis.end(), table[i].basis);
    }
    return make_buffer(std::span<const gpu::Direction>(table));
}

void DepthMaps::draw(const GlObject& program, const GlObject& target, const glm::vec3& direction) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target.name());
    glViewport(0, 0, resolution_, resolution_);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glUseProgram(program.name());
    glBindVertexArray(no_vertices_.name());
    const glm::mat4 matrix = map_matrix(direction);
    glUniformMatrix4fv(uniform(program, "map_from_world"), 1, GL_FALSE, &matrix[0][0]);
    const float texel = 2 * radius_ / static_cast<float>(resolution_);
    set_uniform(program, "texel_area", texel * texel);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * scene_.triangles()));
}

void DepthMaps::draw(std::span<const glm::vec3> directions) const {
    for (std::size_t i = 0; i < directions.size(); ++i) {
        glNamedFramebufferTextureLayer(target_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0,
                                       static_cast<GLint>(i));
        const float far = 1;
        glClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, &far);
        draw(program_, target_, directions[i]);
    }
}

void DepthMaps::peel(const glm::vec3& direction, const std::function<void()>& look_up) const {
    const GLuint target = layers_->target.name();
    const float far = 1, nothing = 0;
    glClearTexImage(layers_->depth[1].name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, &nothing);
    GLuint query = 0;
    glGenQueries(1, &query);
    for (std::size_t layer = 0; layer < kMaxLayers; ++layer) {
        const GLuint now = layers_->depth[layer % 2].name(), last = layers_->depth[1 - layer % 2].name();
        glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, now, 0);
        glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far);
        glClearNamedFramebufferfv(target, GL_COLOR, 0, &nothing);
        glBindTextureUnit(PRT_UNIT_LAST_DEPTH, last);
        glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
        draw(layers_->program, layers_->target, direction);
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        GLuint any = 0;
        glGetQueryObjectuiv(query, GL_QUERY_RESULT, &any);
        if (!any)
            break;
        glBindTextureUnit(PRT_UNIT_LAST_DEPTH, now);
        glBindTextureUnit(PRT_UNIT_LAYER_COVERAGE, layers_->coverage.name());
        look_up();
    }
    glDeleteQueries(1, &query);
}

void DepthMaps::bind() const {
    glBindTextureUnit(PRT_UNIT_OPAQUE_DEPTH, maps_.name());
}

} // namespace prt
