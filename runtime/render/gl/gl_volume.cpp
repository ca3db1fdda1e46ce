// Lights volumes by a compute shader.

#include "runtime/render/gl/gl_volume.h"

#include "prt/shader/shader_source.h"
#include "runtime/transfer/volume_weights.h"
#include "shared_layout.h"

#include <epoxy/gl.h>

#include <string>

namespace prt {
namespace {

static_assert(kNormalBias == static_cast<float>(PRT_VOLUME_NORMAL_BIAS) &&
              kVisibilityCells == static_cast<float>(PRT_VOLUME_VISIBILITY_CELLS) &&
              kVisibilityFull == static_cast<float>(PRT_VOLUME_VISIBILITY_FULL) &&
              kVisibilityNone == static_cast<float>(PRT_VOLUME_VISIBILITY_NONE) &&
              kHiddenWeight == static_cast<float>(PRT_VOLUME_HIDDEN_WEIGHT));

GLenum format_of(VolumeFormat format) {
    return format == VolumeFormat::rgba16 ? GL_RGBA16F : GL_RGBA32F;
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
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
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

GlVolume::GlVolume(const CompressedVolume& volume, VolumeFormat format)
    : format_(format), relighter_(volume, format), computed_(relighter_.rows()) {
    const ClusteredTransfer& transfer = volume.compressed.transfer;
    const std::string defines = relight_defines(transfer) + "#define PRT_VOLUME_ORDER " +
                                std::to_string(volume.order) + "\n#define PRT_VOLUME_FORMAT " +
                                (format == VolumeFormat::rgba16 ? "rgba16f\n" : "rgba32f\n");
    program_ = make_compute_program("prt_volume.comp", defines);
    const std::vector<ClusterLayout> clusters = cluster_layouts(transfer.bases);
    clusters_ = make_buffer(std::span<const ClusterLayout>(clusters));
    constants_ = make_buffer(std::span<const glm::vec4>(computed_));
    words_ = make_buffer(std::span<const std::byte>(transfer.receivers.weights));
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const auto& probes = lookup.probes().of_brick;
    probes_ = make_buffer(std::as_bytes(std::span(probes)));
    const VolumeAtlas& atlas = relighter_.atlas();
    const std::vector<std::uint32_t> visibility =
                                         visibility_texels(volume.grid, lookup.probes(), volume.visibility),
                                     index = index_texels(volume.grid, lookup.index());
    visibility_ = make_words(GL_RG32UI, GL_RG_INTEGER, atlas.visibility_texels(), visibility);
    index_ = make_words(GL_R32UI, GL_RED_INTEGER, volume.grid.size, index);
    light_ = make_texture_3d(format_of(format), atlas.light_texels(),
                             format == VolumeFormat::rgba16 ? GL_LINEAR : GL_NEAREST);
    bytes_ = clusters.size() * sizeof(ClusterLayout) + computed_.size() * sizeof(glm::vec4) +
             transfer.receivers.weights.size() + probes.size() * sizeof(probes[0]) +
             4 * (visibility.size() + index.size()) + relighter_.bytes();
}

void GlVolume::set_light(const Lighting& lighting, const std::optional<glm::vec3>& sun) {
    relighter_.update_constants(lighting, sun, computed_);
    glNamedBufferSubData(constants_.name(), 0, static_cast<GLsizeiptr>(computed_.size() * sizeof(glm::vec4)),
                         computed_.data());
    glUseProgram(program_.name());
    bind_storage(PRT_BINDING_CONSTANTS, constants_);
    bind_storage(PRT_BINDING_CLUSTERS, clusters_);
    bind_storage(PRT_BINDING_VOLUME_WORDS, words_);
    bind_storage(PRT_BINDING_VOLUME_PROBES, probes_);
    glBindImageTexture(PRT_IMAGE_VOLUME, light_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, format_of(format_));
    const glm::uvec3 groups(relighter_.atlas().bricks);
    glDispatchCompute(groups.x, groups.y, groups.z);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void GlVolume::upload(std::span<const std::byte> texels) {
    const glm::ivec3 size = relighter_.atlas().light_texels();
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(light_.name(), 0, 0, 0, 0, size.x, size.y, size.z, GL_RGBA,
                        format_ == VolumeFormat::rgba16 ? GL_HALF_FLOAT : GL_FLOAT, texels.data());
    check_gl("the light of a volume");
}

void GlVolume::bind() const {
    glBindTextureUnit(PRT_UNIT_VOLUME_LIGHT, light_.name());
    glBindTextureUnit(PRT_UNIT_VOLUME_VISIBILITY, visibility_.name());
    glBindTextureUnit(PRT_UNIT_VOLUME_INDEX, index_.name());
}

std::vector<glm::vec4> GlVolume::read() const {
    const VolumeAtlas& atlas = relighter_.atlas();
    std::vector<glm::vec4> texels(atlas.texels_of_plane() * static_cast<std::size_t>(atlas.planes()));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(light_.name(), 0, GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(texels.size() * sizeof(glm::vec4)), texels.data());
    check_gl("reading a volume back");
    return texels;
}

} // namespace prt
