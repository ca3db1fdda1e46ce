// Uploads occluders for shaders.

#include "runtime/render/gl/gl_occluders.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "shared_layout.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <string>

namespace prt {
namespace {

static_assert(kOccluderSide == PRT_OCCLUDER_SIDE && kMaxOccluders == PRT_MAX_OCCLUDERS &&
              kOccluderFade == static_cast<float>(PRT_OCCLUDER_FADE) &&
              kOccluderBorder == static_cast<float>(PRT_OCCLUDER_BORDER));

/// The block PrtOccluders of shaders/prt_occluders.glsl, std140.
struct Block {
    std::array<PlacedOccluder, kMaxOccluders> objects;
    std::array<std::int32_t, 4> count;
};
static_assert(sizeof(Block) == sizeof(glm::vec4) * (5 * kMaxOccluders + 1));

} // namespace

GlOccluders::GlOccluders(std::span<const OcclusionVolume> volumes)
    : block_(make_buffer(std::span<const std::byte>(std::array<std::byte, sizeof(Block)>{}))) {
    const auto depth = static_cast<GLsizei>(kOccluderSide * static_cast<int>(volumes.size()));
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    if (depth > most)
        throw Error(counted(volumes.size(), "occlusion volume needs", "occlusion volumes need") +
                    " a 3D texture of depth " + std::to_string(depth) + ", but the limit of this device is " +
                    std::to_string(most));
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &name);
    texture_ = GlObject(GlKind::texture, name);
    glTextureStorage3D(name, 1, GL_RGBA8_SNORM, kOccluderSide, kOccluderSide, std::max(depth, 1));
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTextureParameteri(name, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
    const std::vector<OccluderTexel> texels = occluder_texture(volumes);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (depth > 0)
        glTextureSubImage3D(name, 0, 0, 0, 0, kOccluderSide, kOccluderSide, depth, GL_RGBA, GL_BYTE,
                            texels.data());
    check_gl("occlusion volumes");
}

void GlOccluders::use(std::span<const PlacedOccluder> objects) {
    if (objects.size() > kMaxOccluders)
        throw Error("a shader supports at most " + counted(kMaxOccluders, "occluder") + ", not " +
                    std::to_string(objects.size()));
    Block block{};
    std::ranges::copy(objects, block.objects.begin());
    block.count[0] = static_cast<std::int32_t>(objects.size());
    glNamedBufferSubData(block_.name(), 0, sizeof block, &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, PRT_BINDING_OCCLUDERS, block_.name());
    glBindTextureUnit(PRT_UNIT_OCCLUDERS, texture_.name());
}

} // namespace prt
