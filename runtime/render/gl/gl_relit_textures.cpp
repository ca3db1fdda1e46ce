// Computes the textures of lightmaps and volumes by a compute shader.

#include "runtime/render/gl/gl_relit_textures.h"

#include "prt/render/lightmap_file.h"
#include "prt/shader/shader_source.h"
#include "runtime/domains/volume_weights.h"
#include "runtime/render/gl/gl_scene.h"
#include "shared_layout.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <string>

namespace prt {
namespace {

static_assert(kNormalBias == static_cast<float>(PRT_VOLUME_NORMAL_BIAS) &&
              kVisibilityCells == static_cast<float>(PRT_VOLUME_VISIBILITY_CELLS) &&
              kVisibilityFull == static_cast<float>(PRT_VOLUME_VISIBILITY_FULL) &&
              kVisibilityNone == static_cast<float>(PRT_VOLUME_VISIBILITY_NONE) &&
              kHiddenWeight == static_cast<float>(PRT_VOLUME_HIDDEN_WEIGHT));

GLenum format_of(TexelFormat format) {
    return format == TexelFormat::rgba32   ? GL_RGBA32F
           : format == TexelFormat::rgba16 ? GL_RGBA16F
                                           : GL_R11F_G11F_B10F;
}

void set_filter(const GlObject& texture, GLint minified, GLint magnified) {
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, minified);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, magnified);
}

GlObject make_map(const LightmapSize& size, GLenum format) {
    const int levels = std::bit_width(static_cast<unsigned>(std::max(size.width, size.height)));
    GlObject map = make_texture_2d(levels, format, size.width, size.height);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTextureParameteri(map.name(), wrap, size.repeats ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    set_filter(map, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
    return map;
}

GlObject make_words(const LightmapSize& size, std::span<const std::uint32_t> words) {
    GlObject texture = make_texture_2d(1, GL_R32UI, size.width, size.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(texture.name(), 0, 0, 0, size.width, size.height, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        words.data());
    set_filter(texture, GL_NEAREST, GL_NEAREST);
    return texture;
}

GlObject make_texture_3d(GLenum format, const glm::ivec3& size, GLint filter) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    if (size.x > most || size.y > most || size.z > most)
        throw Error("the volume needs a texture of " + std::to_string(size.x) + " x " +
                    std::to_string(size.y) + " x " + std::to_string(size.z) +
                    " texels, but the limit of this device is " + std::to_string(most) + " per side");
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &name);
    GlObject texture(GlKind::texture, name);
    glTextureStorage3D(name, 1, format, size.x, size.y, size.z);
    set_filter(texture, filter, filter);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
    check_gl("a volume");
    return texture;
}

GlObject make_words(GLenum format, GLenum components, const glm::ivec3& size,
                    std::span<const std::uint32_t> words) {
    GlObject texture = make_texture_3d(format, size, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(texture.name(), 0, 0, 0, 0, size.x, size.y, size.z, components, GL_UNSIGNED_INT,
                        words.data());
    return texture;
}

} // namespace

GlRelitTextures::GlRelitTextures(const ClusteredTransfer& transfer, const TextureRelighter& relighter)
    : relighter_(relighter), computed_(relighter.rows()),
      program_(make_compute_program("prt_texels.comp", texel_defines(transfer, relighter.format()))) {
    const std::vector<ClusterLayout> clusters = cluster_layouts(transfer.bases);
    clusters_ = make_buffer(std::span<const ClusterLayout>(clusters));
    constants_ = make_buffer(std::span<const glm::vec4>(computed_));
    bytes_ = clusters.size() * sizeof(ClusterLayout) + computed_.size() * sizeof(glm::vec4) +
             transfer.receivers.weights.size();
    for (std::size_t t = 0; t < relighter_.textures(); ++t)
        bytes_ += relighter_.bytes(t);
}

GlRelitTextures::GlRelitTextures(const CompressedLightmap& lightmap, TexelFormat format)
    : GlRelitTextures(lightmap.compressed.transfer, TextureRelighter(lightmap, format)) {
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m) {
        const LightmapSize& size = lightmap.layout.maps[m];
        std::vector<GlObject>& words = words_.emplace_back();
        for (int w = 0; w < lightmap.compressed.transfer.receivers.words; ++w)
            words.push_back(make_words(size, words_of_map(lightmap, m, w)));
        textures_.push_back(make_map(size, format_of(format)));
    }
}

GlRelitTextures::GlRelitTextures(const CompressedVolume& volume, TexelFormat format)
    : GlRelitTextures(volume.compressed.transfer, TextureRelighter(volume, format)) {
    words_.emplace_back().push_back(
        make_buffer(std::span<const std::byte>(volume.compressed.transfer.receivers.weights)));
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const auto bricks = std::as_bytes(std::span(lookup.probes().of_brick));
    probes_ = make_buffer(bricks);
    const std::vector<std::uint32_t> visibility =
                                         visibility_texels(volume.grid, lookup.probes(), volume.visibility),
                                     index = index_texels(volume.grid, lookup.index());
    const VolumeAtlas& atlas = relighter_.atlas();
    visibility_ = make_words(GL_RG32UI, GL_RG_INTEGER, atlas.visibility_texels(), visibility);
    index_ = make_words(GL_R32UI, GL_RED_INTEGER, volume.grid.size, index);
    textures_.push_back(make_texture_3d(format_of(format), atlas.light_texels(),
                                        format == TexelFormat::rgba16 ? GL_LINEAR : GL_NEAREST));
    bytes_ += bricks.size() + 4 * (visibility.size() + index.size());
}

void GlRelitTextures::set_light(const Lighting& lighting, const std::optional<glm::vec3>& sun) {
    relighter_.update_constants(lighting, sun, computed_);
    glNamedBufferSubData(constants_.name(), 0, static_cast<GLsizeiptr>(computed_.size() * sizeof(glm::vec4)),
                         computed_.data());
    glUseProgram(program_.name());
    bind_storage(PRT_BINDING_CONSTANTS, constants_);
    bind_storage(PRT_BINDING_CLUSTERS, clusters_);
    const bool is_volume = probes_.name() != 0;
    for (std::size_t t = 0; t < textures_.size(); ++t) {
        if (is_volume) {
            bind_storage(PRT_BINDING_VOLUME_WORDS, words_[t][0]);
            bind_storage(PRT_BINDING_VOLUME_PROBES, probes_);
        }
        for (std::size_t w = 0; !is_volume && w < words_[t].size(); ++w)
            glBindTextureUnit(static_cast<GLuint>(PRT_UNIT_WORD_IMAGES + w), words_[t][w].name());
        glBindImageTexture(PRT_IMAGE_TEXELS, textures_[t].name(), 0, is_volume, 0, GL_WRITE_ONLY,
                           format_of(relighter_.format()));
        const glm::uvec3 groups(is_volume ? relighter_.atlas().bricks
                                          : (relighter_.levels(t)[0].size + 7) / 8);
        glDispatchCompute(groups.x, groups.y, groups.z);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    for (std::size_t t = 0; !is_volume && t < textures_.size(); ++t)
        glGenerateTextureMipmap(textures_[t].name());
}

void GlRelitTextures::bind_volume() const {
    glBindTextureUnit(PRT_UNIT_VOLUME_LIGHT, textures_[0].name());
    glBindTextureUnit(PRT_UNIT_VOLUME_VISIBILITY, visibility_.name());
    glBindTextureUnit(PRT_UNIT_VOLUME_INDEX, index_.name());
}

std::vector<glm::vec4> GlRelitTextures::read(std::size_t texture) const {
    const TextureLevel& level = relighter_.levels(texture)[0];
    std::vector<glm::vec4> texels(level.texel(0, level.size.y * level.size.z));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(textures_[texture].name(), 0, GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)), texels.data());
    check_gl("reading relit texels back");
    return texels;
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
