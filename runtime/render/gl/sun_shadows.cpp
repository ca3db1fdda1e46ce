// Draws shadow casters into arrays of depth maps.

#include "runtime/render/gl/sun_shadows.h"

#include "runtime/render/gl/map_fit.h"

#include "prt/core/error.h"

#include <epoxy/gl.h>
#include <glm/common.hpp>

#include <algorithm>
#include <numbers>
#include <string>

namespace prt {
namespace {

/// Maximum number of texels of all maps: 256 MB of depths.
constexpr std::size_t kMaxTexels = std::size_t{1} << 26;
constexpr int kMinMap = 256;

GlObject make_array(GLenum format, int size, int layers) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    GlObject texture(GlKind::texture, name);
    glTextureStorage3D(name, 1, format, size, size, layers);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    check_gl("shadow maps");
    return texture;
}

bool same(const Sun& a, const Sun& b) {
    return a.towards == b.towards && a.irradiance == b.irradiance && a.half_angle == b.half_angle;
}

suns::SunLight light_of(const Sun& sun) {
    return {glm::vec4(sun.towards, static_cast<float>(tangent_of(sun))),
            glm::vec4(sun.irradiance / std::numbers::pi_v<float>, 0)};
}

/// Returns a power of two that provides two texels per pixel, if the limits allow it.
int size_of_maps(std::span<const Sun> discs, const std::vector<Slice>& slices, const SeenScene& seen,
                 int largest) {
    double wanted = kMinMap;
    for (const Sun& sun : discs)
        for (const Slice& slice : slices)
            if (!slice.corners.empty())
                wanted = std::max(wanted, texels_wanted(sun, slice, seen));
    int size = kMinMap;
    const std::size_t maps = std::max<std::size_t>(1, discs.size() * slices.size());
    const auto fits = [&](int side) {
        return side <= largest &&
               maps * static_cast<std::size_t>(side) * static_cast<std::size_t>(side) <= kMaxTexels;
    };
    while (size < wanted && fits(2 * size))
        size *= 2;
    return size;
}

} // namespace

SunShadows::SunShadows(const GlScene& scene, int largest_map)
    : scene_(scene), box_(bounds(scene.scene())), largest_map_(largest_map),
      casters_(scene.make_vertex_arrays()), blocking_(make_program("sun_caster.vert", "sun_caster.frag")) {
    for (const Primitive& primitive : scene.scene().primitives)
        layered_ |= scene.blocking(primitive) == Blocking::term;
    if (layered_)
        partly_ = make_program("sun_caster.vert", "sun_caster.frag", "#define PRT_PARTLY\n");
    suns_ = make_buffer(std::span<const suns::SunsSeen>(std::vector<suns::SunsSeen>(1)));
}

void SunShadows::resize(int size, int count) {
    if (size == size_ && count == maps_.count)
        return;
    maps_ = {}; // free first: there may not be memory for both
    maps_.depth = make_array(GL_DEPTH_COMPONENT32F, size, count);
    // Without layers nothing reads these textures, but a sampler needs a texture.
    maps_.layers = make_array(GL_RG32F, layered_ ? size : 1, layered_ ? count : 1);
    maps_.passes = make_array(GL_R16F, layered_ ? size : 1, layered_ ? count : 1);
    maps_.framebuffer = make_framebuffer();
    maps_.count = count;
    size_ = size;
}

void SunShadows::draw(std::span<const Sun> discs, const View& view, const Moving& moving) {
    if (discs.size() > kMaxShadowedSuns)
        throw Error("the OpenGL renderer supports shadows of at most " + std::to_string(kMaxShadowedSuns) +
                    " suns, not " + std::to_string(discs.size()));
    if (size_ > 0 && view == drawn_.view && moving.version == drawn_.moved &&
        std::ranges::equal(discs, drawn_.suns, same))
        return;
    Bounds box = box_;
    if (moving.draw)
        box = {glm::min(box.low, moving.box.low), glm::max(box.high, moving.box.high)};
    const SeenScene seen{view.camera, view.width, view.height, box};
    const std::vector<Slice> slices = slices_of(seen);
    const int size = size_of_maps(discs, slices, seen, largest_map_);
    suns::SunsSeen data{};
    data.eye = glm::vec4(view.camera.position, 0);
    data.forward = glm::vec4(camera_frame(view.camera).forward, 0);
    data.count = static_cast<int>(discs.size());
    data.slices = static_cast<int>(slices.size());
    data.layered = layered_;
    std::vector<int> drawn;
    for (std::size_t s = 0; s < discs.size(); ++s) {
        data.suns[s] = light_of(discs[s]);
        for (std::size_t i = 0; i < slices.size(); ++i) {
            const std::size_t map = s * slices.size() + i;
            data.slice_ends[static_cast<int>(i)] = static_cast<float>(slices[i].to);
            if (slices[i].corners.empty())
                continue;
            data.maps[map] = fitted_map(discs[s], slices[i], seen, size);
            drawn.push_back(static_cast<int>(map));
        }
    }
    resize(size, std::max(1, static_cast<int>(discs.size() * slices.size())));
    glNamedBufferSubData(suns_.name(), 0, sizeof(data), &data);
    for (const int map : drawn)
        draw_map(map, moving);
    drawn_ = {{discs.begin(), discs.end()}, view, moving.version};
    check_gl("shadow maps");
}

void SunShadows::draw_map(int map, const Moving& moving) const {
    constexpr float kFar = 1;
    const GLuint framebuffer = maps_.framebuffer.name();
    glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, maps_.depth.name(), 0, map);
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, 0, 0);
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT1, 0, 0);
    glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size_, size_);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &kFar);
    draw_blocking(blocking_, map);
    if (moving.draw) {
        bind_storage(PRT_BINDING_SUNS, suns_);
        moving.draw(map, size_);
    }
    if (layered_)
        draw_partly_blocking(map);
}

void SunShadows::set_map(const GlObject& program, int map, int size) {
    glUniform1i(uniform(program, "map"), map);
    set_uniform(program, "map_size", static_cast<float>(size));
}

/// Draws the casters that belong to `program`.
void SunShadows::draw_blocking(const GlObject& program, int map) const {
    const Blocking drawn = &program == &blocking_ ? Blocking::all : Blocking::term;
    glUseProgram(program.name());
    bind_storage(PRT_BINDING_SUNS, suns_);
    set_map(program, map, size_);
    const std::vector<Primitive>& primitives = scene_.scene().primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p)
        if (scene_.blocking(primitives[p]) == drawn)
            scene_.draw_caster(program, casters_, p);
}

/// Draws the partly blocking casters. Blending computes the first and the last layer as minima of depths and
/// negative depths, and the transmittance as a product.
void SunShadows::draw_partly_blocking(int map) const {
    constexpr float kNowhere[4] = {1e30f, 1e30f, 0, 0}, kAll[4] = {1, 1, 1, 1};
    const GLuint framebuffer = maps_.framebuffer.name();
    glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT0, maps_.layers.name(), 0, map);
    glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT1, maps_.passes.name(), 0, map);
    constexpr GLenum kTargets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer, 2, kTargets);
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, kNowhere);
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 1, kAll);
    glDepthMask(GL_FALSE); // nothing is needed behind opaque casters
    glEnable(GL_BLEND);
    glBlendEquationi(0, GL_MIN);
    glBlendFunci(1, GL_ZERO, GL_SRC_COLOR);
    draw_blocking(partly_, map);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

void SunShadows::use() const {
    bind_storage(PRT_BINDING_SUNS, suns_);
    glBindTextureUnit(PRT_UNIT_SUN_DEPTH, maps_.depth.name());
    glBindTextureUnit(PRT_UNIT_SUN_LAYERS, maps_.layers.name());
    glBindTextureUnit(PRT_UNIT_SUN_PASSES, maps_.passes.name());
}

} // namespace prt
