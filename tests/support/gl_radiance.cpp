// Computes radiance of vertices and lightmaps with OpenGL.

#include "support/gl_radiance.h"

#include "prt/render/lightmap_file.h"
#include "prt/shader/shader_source.h"
#include "runtime/render/gl/gl_objects.h"
#include "runtime/render/gl/gl_relit_textures.h"
#include "runtime/render/gl/gl_scene.h"
#include "runtime/render/gl/gl_transfer.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <span>

namespace prt::test {
namespace {

/// Points `location` of `vertex_array` at vectors of three floats.
void attach_vectors(GLuint vertex_array, GLuint location, const GlObject& buffer) {
    glVertexArrayVertexBuffer(vertex_array, location, buffer.name(), 0, sizeof(glm::vec3));
    glEnableVertexArrayAttrib(vertex_array, location);
    glVertexArrayAttribFormat(vertex_array, location, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array, location, location);
}

/// Attaches the attributes of predictors to a mesh, from the coordinates of all receivers.
std::vector<GlObject> attach_predictors(GLuint vertex_array, const ClusteredTransfer& transfer) {
    std::vector<GlObject> buffers;
    const ClusteredBases& bases = transfer.bases;
    for (std::size_t g = 0; g < bases.predictors.size(); ++g) {
        std::vector<glm::vec3> vectors;
        for (std::size_t p = 0; p < transfer.receivers.size(); ++p)
            vectors.push_back(
                glm::make_vec3(&transfer.receivers.predictors[p * bases.predictor_rows() + 3 * g]) +
                bases.predictors[g].origin);
        const bool normal = bases.predictors[g].kind == PredictorKind::normal;
        attach_vectors(vertex_array, normal ? PRT_LOCATION_NORMAL : PRT_LOCATION_POSITION,
                       buffers.emplace_back(make_buffer(std::span<const glm::vec3>(vectors))));
    }
    return buffers;
}

/// Binds the words of a map, each in a texture of four bytes per texel at its unit, as prt_lightmap.frag
/// reads them.
std::vector<GlObject> bind_words(const CompressedLightmap& lightmap, std::size_t map) {
    std::vector<GlObject> textures;
    for (int w = 0; w < lightmap.compressed.transfer.receivers.words; ++w) {
        const LightmapSize& size = lightmap.layout.maps[map];
        const GlObject& texture =
            textures.emplace_back(make_texture_2d(1, GL_RGBA8UI, size.width, size.height));
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(texture.name(), 0, 0, 0, size.width, size.height, GL_RGBA_INTEGER,
                            GL_UNSIGNED_BYTE, words_of_map(lightmap, map, w).data());
        glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glBindTextureUnit(static_cast<GLuint>(PRT_UNIT_WORD_IMAGES + w), texture.name());
    }
    return textures;
}

/// Constants and clusters of a lightmap for one lighting, bound as shaders want them.
struct BoundConstants {
    GlObject constants, clusters;

    BoundConstants(const ClusteredTransfer& transfer, const Lighting& lighting) {
        const ClusterLighting relighter(transfer);
        std::vector<glm::vec4> computed(relighter.rows());
        relighter.update(lighting, computed);
        constants = make_buffer(std::span<const glm::vec4>(computed));
        clusters = make_buffer(std::span<const ClusterLayout>(cluster_layouts(transfer.bases)));
        bind_storage(PRT_BINDING_CONSTANTS, constants);
        bind_storage(PRT_BINDING_CLUSTERS, clusters);
    }
};

void append_texture(const GlObject& texture, const LightmapSize& size, std::vector<glm::vec3>& radiance) {
    const std::size_t begin = radiance.size();
    radiance.resize(begin + size.texels());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(texture.name(), 0, GL_RGB, GL_FLOAT,
                      static_cast<GLsizei>(size.texels() * sizeof(glm::vec3)), &radiance[begin]);
    check_gl("reading a lightmap back");
}

} // namespace

std::vector<glm::vec3> exit_radiance_gl(const ClusteredTransfer& transfer, const Lighting& lighting,
                                        const GlContext& context) {
    context.make_current();
    GlTransfer on_gpu(transfer);
    on_gpu.set_light(lighting);
    const GlObject program = make_program("scene.vert", "scene.frag", on_gpu.defines(), "radiance");
    const GlObject vertex_array = make_vertex_array();
    on_gpu.attach(vertex_array.name(), 0);
    const std::vector<GlObject> predictors = attach_predictors(vertex_array.name(), transfer);
    std::vector<glm::vec3> radiance(transfer.receivers.size());
    const GlObject output = make_buffer(std::span<const glm::vec3>(radiance));
    // Nothing is drawn, but without a window there is no framebuffer unless the test creates one.
    const GlObject framebuffer = make_framebuffer();
    glNamedFramebufferParameteri(framebuffer.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
    glNamedFramebufferParameteri(framebuffer.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glUseProgram(program.name());
    on_gpu.use();
    glBindVertexArray(vertex_array.name());
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, output.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(radiance.size()));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    read_buffer(output, std::span(radiance), "reading the vertex shader's result back");
    return radiance;
}

std::vector<glm::vec3> lightmap_radiance_gl(const CompressedLightmap& lightmap, const Lighting& lighting,
                                            const GlContext& context) {
    context.make_current();
    GlRelitTextures relit(lightmap, TexelFormat::rgba32);
    relit.set_light(lighting);
    std::vector<glm::vec3> radiance;
    for (std::size_t m = 0; m < relit.textures().size(); ++m)
        for (const glm::vec4& texel : relit.read(m))
            radiance.emplace_back(texel);
    return radiance;
}

std::vector<glm::vec3> lightmap_radiance_by_fragments(const CompressedLightmap& lightmap,
                                                      const Lighting& lighting, const GlContext& context) {
    context.make_current();
    const ClusteredTransfer& transfer = lightmap.compressed.transfer;
    const BoundConstants bound(transfer, lighting);
    const GlObject program = make_program("background.vert", "prt_lightmap.frag", relight_defines(transfer)),
                   empty = make_vertex_array(), framebuffer = make_framebuffer();
    glUseProgram(program.name());
    glBindVertexArray(empty.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    std::vector<glm::vec3> radiance;
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m) {
        const LightmapSize& size = lightmap.layout.maps[m];
        const std::vector<GlObject> words = bind_words(lightmap, m);
        const GlObject map = make_texture_2d(1, GL_RGBA32F, size.width, size.height);
        glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, map.name(), 0);
        glViewport(0, 0, size.width, size.height);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        append_texture(map, size, radiance);
    }
    return radiance;
}

} // namespace prt::test
