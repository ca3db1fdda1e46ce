// Lights lightmaps by a compute shader.

#include "runtime/render/gl/gl_lightmap.h"

#include "prt/render/lightmap_file.h"
#include "prt/shader/shader_source.h"
#include "runtime/render/gl/gl_scene.h"
#include "shared_layout.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>

namespace prt {
namespace {

int level_count(const LightmapSize& size) {
    return std::bit_width(static_cast<unsigned>(std::max(size.width, size.height)));
}

GlObject make_map(const LightmapSize& size, GLenum format) {
    GlObject map = make_texture_2d(level_count(size), format, size.width, size.height);
    const GLint wrap = size.repeats ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTextureParameteri(map.name(), GL_TEXTURE_WRAP_S, wrap);
    glTextureParameteri(map.name(), GL_TEXTURE_WRAP_T, wrap);
    glTextureParameteri(map.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(map.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return map;
}

GlObject make_words(const LightmapSize& size, std::span<const std::uint32_t> words) {
    GlObject texture = make_texture_2d(1, GL_R32UI, size.width, size.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(texture.name(), 0, 0, 0, size.width, size.height, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        words.data());
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

GLuint groups(int texels) {
    return static_cast<GLuint>(texels + 7) / 8;
}

void dispatch(const GlObject& map, const LightmapSize& size, std::span<const GlObject> words) {
    for (std::size_t w = 0; w < words.size(); ++w)
        glBindTextureUnit(static_cast<GLuint>(PRT_UNIT_WORD_IMAGES + w), words[w].name());
    glBindImageTexture(PRT_IMAGE_LIGHTMAP, map.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    glDispatchCompute(groups(size.width), groups(size.height), 1);
}

} // namespace

GlLightmap::GlLightmap(const CompressedLightmap& lightmap)
    : layout_(lightmap.layout), relighter_(lightmap.compressed.transfer), computed_(relighter_.rows()),
      program_(make_compute_program("prt_lightmap.comp", relight_defines(lightmap.compressed.transfer))) {
    const ClusteredTransfer& transfer = lightmap.compressed.transfer;
    const std::vector<ClusterLayout> clusters = cluster_layouts(transfer.bases);
    clusters_ = make_buffer(std::span<const ClusterLayout>(clusters));
    constants_ = make_buffer(std::span<const glm::vec4>(computed_));
    bytes_ = clusters.size() * sizeof(ClusterLayout) + computed_.size() * sizeof(glm::vec4);
    for (std::size_t m = 0; m < layout_.maps.size(); ++m) {
        const LightmapSize& size = layout_.maps[m];
        std::vector<GlObject>& words = words_.emplace_back();
        for (int w = 0; w < transfer.receivers.words; ++w)
            words.push_back(make_words(size, words_of_map(lightmap, m, w)));
        maps_.push_back(make_map(size, GL_RGBA16F));
        bytes_ += size.texels() * (transfer.receivers.stride() + 8 * 4 / 3);
    }
}

void GlLightmap::set_light(const Lighting& lighting) {
    relighter_.update(lighting, computed_);
    glNamedBufferSubData(constants_.name(), 0, static_cast<GLsizeiptr>(computed_.size() * sizeof(glm::vec4)),
                         computed_.data());
    glUseProgram(program_.name());
    bind_storage(PRT_BINDING_CONSTANTS, constants_);
    bind_storage(PRT_BINDING_CLUSTERS, clusters_);
    for (std::size_t m = 0; m < maps_.size(); ++m)
        dispatch(maps_[m], layout_.maps[m], words_[m]);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    for (const GlObject& map : maps_)
        glGenerateTextureMipmap(map.name());
}

std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout,
                                             std::span<const glm::vec3> radiance) {
    std::vector<GlObject> maps;
    const std::vector<std::size_t> first = layout.first_texels();
    for (std::size_t m = 0; m < layout.maps.size(); ++m) {
        const LightmapSize& size = layout.maps[m];
        const GlObject& map = maps.emplace_back(make_map(size, GL_RGB16F));
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(map.name(), 0, 0, 0, size.width, size.height, GL_RGB, GL_FLOAT,
                            radiance.data() + first[m]);
        glGenerateTextureMipmap(map.name());
    }
    check_gl("lightmaps");
    return maps;
}

std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout) {
    std::vector<GlObject> maps;
    for (const LightmapSize& size : layout.maps)
        maps.push_back(make_map(size, GL_RGBA16F));
    return maps;
}

} // namespace prt
