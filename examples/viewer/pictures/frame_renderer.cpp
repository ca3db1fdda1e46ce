// Draws the pictures of both sides and composites them.

#include "pictures/frame_renderer.h"

#include "prt/core/error.h"
#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace viewer {
namespace {

/// Display color of the texel grid: base colors, heat colors and most lights differ from it.
constexpr glm::vec3 kGridColor(0.0f, 0.3f, 0.55f);

prt::GlObject make_target(GLenum format, int width, int height) {
    prt::GlObject texture = prt::make_texture_2d(1, format, width, height);
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

prt::GlObject make_framebuffer(std::initializer_list<const prt::GlObject*> colors,
                               const prt::GlObject* depth) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    prt::GlObject framebuffer(prt::GlKind::framebuffer, name);
    std::vector<GLenum> attachments;
    for (const prt::GlObject* color : colors) {
        attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
        glNamedFramebufferTexture(name, attachments.back(), color->name(), 0);
    }
    if (depth)
        glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth->name(), 0);
    glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(attachments.size()), attachments.data());
    if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw prt::Error("the device cannot render to the texture formats of the viewer");
    return framebuffer;
}

/// Returns a box around the model and the moving objects.
prt::Bounds box_of(const GpuModel& model, const FrameView& view) {
    const prt::Bounds& box = model.model().box;
    const auto moving = view.moving ? view.moving->box() : std::nullopt;
    return moving ? prt::Bounds{glm::min(box.low, moving->low), glm::max(box.high, moving->high)} : box;
}

/// Returns the number of work groups of viewer_difference.comp along an axis.
int groups_along(int pixels) {
    return (pixels + 15) / 16;
}

} // namespace

FrameRenderer::FrameRenderer()
    : programs_{prt::make_program("background.vert", "background.frag"),
                prt::make_program("background.vert", "viewer_ssao.frag"),
                prt::make_program("background.vert", "viewer_ssao_blur.frag"),
                prt::make_program("background.vert", "viewer_deferred.frag"),
                prt::make_program("background.vert", "viewer_composite.frag"),
                prt::make_compute_program("viewer_difference.comp")} {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    no_vertices_ = prt::GlObject(prt::GlKind::vertex_array, name);
}

void FrameRenderer::resize(const FrameSize& size) {
    if (size == size_)
        return;
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    const int width = size.width * size.samples, height = size.height * size.samples;
    if (width > largest || height > largest)
        throw prt::Error("the device supports pictures of at most " + std::to_string(largest) +
                         " pixels along a side");
    gbuffer_.base = make_target(GL_SRGB8_ALPHA8, width, height);
    gbuffer_.normal = make_target(GL_RG16, width, height);
    gbuffer_.radiance = make_target(GL_RGBA16F, width, height);
    for (std::size_t i = 0; i < 2; ++i) {
        Side& side = sides_[i];
        side.color = make_target(GL_RGBA16F, width, height);
        side.depth = make_target(GL_DEPTH_COMPONENT32F, width, height);
        side.framebuffer = make_framebuffer({&side.color}, &side.depth);
        side.color_only = make_framebuffer({&side.color}, nullptr);
        gbuffer_.framebuffers[i] =
            make_framebuffer({&gbuffer_.base, &gbuffer_.normal, &gbuffer_.radiance}, &side.depth);
        ssao_.textures[i] = make_target(GL_R16F, width, height);
        ssao_.framebuffers[i] = make_framebuffer({&ssao_.textures[i]}, nullptr);
    }
    sums_.groups = static_cast<std::size_t>(groups_along(size.width) * groups_along(size.height));
    sums_.buffer = prt::make_buffer(std::span<const glm::vec4>(std::vector<glm::vec4>(sums_.groups)));
    size_ = size;
}

std::size_t FrameRenderer::pixels() const {
    return static_cast<std::size_t>(size_.width * size_.samples) *
           static_cast<std::size_t>(size_.height * size_.samples);
}

void FrameRenderer::fill_screen() const {
    glBindVertexArray(no_vertices_.name());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

GeometryPass FrameRenderer::geometry_pass(const GpuModel& model, const DrawSettings& settings,
                                          const FrameView& view) const {
    const float aspect = static_cast<float>(size_.width) / static_cast<float>(size_.height);
    return {.view_projection = prt::view_projection(view.camera, box_of(model, view), aspect),
            .eye = view.camera.position,
            .culling = settings.culling,
            .textured = settings.textured,
            .dithered = settings.dithered};
}

void FrameRenderer::scissor(const Columns& columns) const {
    glScissor(columns.first * size_.samples, 0, std::max(0, columns.last - columns.first) * size_.samples,
              size_.height * size_.samples);
    glEnable(GL_SCISSOR_TEST);
}

/// Clears `columns` and leaves the scissor enabled there.
void FrameRenderer::clear(const Side& side, PictureKind kind, const Columns& columns) const {
    constexpr float kNothing[4] = {0, 0, 0, 0}, kFar = 1;
    glViewport(0, 0, size_.width * size_.samples, size_.height * size_.samples);
    scissor(columns);
    glClearNamedFramebufferfv(side.framebuffer.name(), GL_COLOR, 0, kNothing);
    if (is_ssao(kind)) // SSAO reads beyond the requested columns
        glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(side.framebuffer.name(), GL_DEPTH, 0, &kFar);
    glEnable(GL_SCISSOR_TEST);
}

void FrameRenderer::draw(int index, PictureKind kind, GpuModel& model, const DrawSettings& settings,
                         const FrameView& view, const Columns& columns) {
    Side& side = sides_[static_cast<std::size_t>(index)];
    side.shows_image = false;
    const bool numbers = shows_numbers(kind);
    GeometryPass pass = geometry_pass(model, settings, view);
    const bool moves = view.moving && view.moving->shows_anything() && !numbers;
    model.draw_shadows(kind, {view.camera, size_.width, size_.height},
                       moves ? view.moving->casters() : prt::SunShadows::Moving());
    const std::optional<OccluderPass> occluders = moves ? view.moving->occluders() : std::nullopt;
    pass.occluders = occluders ? &*occluders : nullptr;
    clear(side, kind, columns);
    if (settings.background && view.background && !numbers)
        draw_background(side, view);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    if (!numbers && (settings.deferred || is_ssao(kind))) {
        draw_deferred(index, kind, model, pass, settings, view);
    } else {
        glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
        model.draw_opaque(kind, pass);
    }
    if (moves)
        draw_moving(model, pass, view);
    model.draw_blended(kind, pass);
    if (settings.wireframe)
        model.draw_wires(pass, glm::vec3(numbers ? 0.1f : 0.15f / view.exposure));
    glDisable(GL_SCISSOR_TEST);
    prt::check_gl("drawing");
}

void FrameRenderer::draw_moving(const GpuModel& model, const GeometryPass& pass,
                                const FrameView& view) const {
    model.use_shadows();
    view.moving->draw({.view_projection = pass.view_projection,
                       .eye = pass.eye,
                       .textured = pass.textured,
                       .exposure = view.exposure,
                       .irradiance = model.irradiance()});
}

void FrameRenderer::draw_texel_grid(int index, PictureKind kind, GpuModel& model,
                                    const DrawSettings& settings, const FrameView& view,
                                    const Columns& columns) {
    glBindFramebuffer(GL_FRAMEBUFFER, sides_[static_cast<std::size_t>(index)].framebuffer.name());
    scissor(columns);
    glEnable(GL_DEPTH_TEST);
    model.draw_texel_grid(geometry_pass(model, settings, view),
                          kGridColor / (shows_numbers(kind) ? 1.0f : view.exposure), size_.samples);
    glDisable(GL_SCISSOR_TEST);
    prt::check_gl("drawing");
}

void FrameRenderer::draw_background(const Side& side, const FrameView& view) const {
    const prt::GlObject& background = program(Pass::background);
    const prt::CameraFrame frame = prt::camera_frame(view.camera);
    const double aspect = static_cast<double>(size_.width) / size_.height;
    const glm::vec3 forward(frame.forward), right(frame.right * (frame.half_height * aspect)),
        up(frame.up * frame.half_height);
    glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
    glUseProgram(background.name());
    glUniform3fv(prt::uniform(background, "forward"), 1, glm::value_ptr(forward));
    glUniform3fv(prt::uniform(background, "right"), 1, glm::value_ptr(right));
    glUniform3fv(prt::uniform(background, "up"), 1, glm::value_ptr(up));
    glUniform1f(prt::uniform(background, "rotation"), view.background_rotation);
    glBindTextureUnit(PRT_UNIT_BACKGROUND, view.background->name());
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE); // alpha marks surfaces
    fill_screen();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

/// Draws opaque surfaces into the G-buffer and lights it; leaves the side's framebuffer bound.
void FrameRenderer::draw_deferred(int index, PictureKind kind, GpuModel& model, GeometryPass pass,
                                  const DrawSettings& settings, const FrameView& view) const {
    const Side& side = sides_[static_cast<std::size_t>(index)];
    pass.gbuffer = true;
    if (is_ssao(kind))
        glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, gbuffer_.framebuffers[static_cast<std::size_t>(index)].name());
    glEnable(GL_FRAMEBUFFER_SRGB);
    model.draw_opaque(kind, pass);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_SCISSOR_TEST);
    if (is_ssao(kind))
        draw_ssao(side, kind, settings.ssao, view, model);
    light_gbuffer(side, model, kind);
    glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
    glEnable(GL_DEPTH_TEST);
}

void FrameRenderer::draw_ssao(const Side& side, PictureKind kind, const SsaoSettings& settings,
                              const FrameView& view, const GpuModel& model) const {
    const float aspect = static_cast<float>(size_.width) / static_cast<float>(size_.height);
    const glm::mat4 matrix = prt::view_projection(view.camera, box_of(model, view), aspect),
                    inverse(glm::inverse(glm::dmat4(matrix)));
    const glm::vec3 forward(prt::camera_frame(view.camera).forward);
    glBindTextureUnit(PRT_UNIT_GBUFFER_NORMAL, gbuffer_.normal.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_DEPTH, side.depth.name());
    for (const Pass pass : {Pass::ssao, Pass::ssao_blur}) {
        const bool blur = pass == Pass::ssao_blur;
        const prt::GlObject& ssao = program(pass);
        glBindFramebuffer(GL_FRAMEBUFFER, ssao_.framebuffers[blur ? 1 : 0].name());
        glUseProgram(ssao.name());
        glUniformMatrix4fv(prt::uniform(ssao, "view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
        glUniformMatrix4fv(prt::uniform(ssao, "inverse_view_projection"), 1, GL_FALSE,
                           glm::value_ptr(inverse));
        glUniform3fv(prt::uniform(ssao, "eye"), 1, glm::value_ptr(view.camera.position));
        glUniform3fv(prt::uniform(ssao, "forward"), 1, glm::value_ptr(forward));
        glUniform1f(prt::uniform(ssao, "radius"), settings.radius * model.model().radius);
        glUniform1f(prt::uniform(ssao, "bias"), settings.bias);
        glUniform1f(prt::uniform(ssao, "intensity"), settings.intensity);
        glUniform1i(prt::uniform(ssao, "pairs"), std::max(1, settings.samples / 2));
        glUniform1i(prt::uniform(ssao, "use_normals"), kind == PictureKind::ssao_normals);
        if (blur)
            glBindTextureUnit(PRT_UNIT_SSAO, ssao_.textures[0].name());
        fill_screen();
    }
}

void FrameRenderer::light_gbuffer(const Side& side, const GpuModel& model, PictureKind kind) const {
    const prt::GlObject& deferred = program(Pass::deferred);
    glBindFramebuffer(GL_FRAMEBUFFER, side.color_only.name());
    glUseProgram(deferred.name());
    glUniform3fv(prt::uniform(deferred, "irradiance_sh"), 9, glm::value_ptr(model.irradiance().front()));
    glUniform1i(prt::uniform(deferred, "has_ssao"), is_ssao(kind));
    glBindTextureUnit(PRT_UNIT_GBUFFER_BASE, gbuffer_.base.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_NORMAL, gbuffer_.normal.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_RADIANCE, gbuffer_.radiance.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_DEPTH, side.depth.name());
    glBindTextureUnit(PRT_UNIT_SSAO, ssao_.textures[1].name());
    fill_screen();
}

void FrameRenderer::show(int index, const prt::Image& image, const std::vector<bool>& surfaces) {
    Side& side = sides_[static_cast<std::size_t>(index)];
    std::vector<glm::vec4> pixels;
    pixels.reserve(image.pixels.size());
    for (int y = image.height - 1; y >= 0; --y) // OpenGL's first row is at the bottom
        for (int x = 0; x < image.width; ++x) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x);
            pixels.emplace_back(glm::min(image.pixels[i], glm::vec3(65000)), surfaces[i] ? 1.0f : 0.0f);
        }
    side.shown = make_target(GL_RGBA16F, image.width, image.height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(side.shown.name(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_FLOAT,
                        pixels.data());
    side.shows_image = true;
}

void FrameRenderer::draw_vertices_only(PictureKind kind, GpuModel& model, const DrawSettings& settings,
                                       const FrameView& view) {
    glBindFramebuffer(GL_FRAMEBUFFER, sides_[0].framebuffer.name());
    glEnable(GL_RASTERIZER_DISCARD);
    model.draw_opaque(kind, geometry_pass(model, settings, view));
    glDisable(GL_RASTERIZER_DISCARD);
}

void FrameRenderer::bind_side_textures() const {
    for (unsigned i = 0; i < 2; ++i)
        glBindTextureUnit(PRT_UNIT_LEFT + i,
                          (sides_[i].shows_image ? sides_[i].shown : sides_[i].color).name());
}

void FrameRenderer::composite(std::uint32_t framebuffer, const Settings& settings, const FrameView& view,
                              const std::array<PictureKind, 2>& kinds, double mean) {
    const prt::GlObject& composite = program(Pass::composite);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size_.width, size_.height);
    glUseProgram(composite.name());
    glUniform2i(prt::uniform(composite, "size"), size_.width, size_.height);
    glUniform1f(prt::uniform(composite, "split"),
                std::round(settings.split * static_cast<float>(size_.width)));
    glUniform2i(prt::uniform(composite, "tone_mapped"), !shows_numbers(kinds[0]), !shows_numbers(kinds[1]));
    glUniform1f(prt::uniform(composite, "exposure"), view.exposure);
    glUniform1i(prt::uniform(composite, "difference"), settings.difference);
    glUniform1f(prt::uniform(composite, "white"), settings.white * static_cast<float>(std::max(mean, 1e-30)));
    bind_side_textures();
    fill_screen();
    prt::check_gl("drawing");
}

Difference FrameRenderer::difference() {
    const prt::GlObject& sums = program(Pass::difference);
    glUseProgram(sums.name());
    glUniform2i(prt::uniform(sums, "size"), size_.width, size_.height);
    bind_side_textures();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_DIFFERENCE, sums_.buffer.name());
    glDispatchCompute(static_cast<GLuint>(groups_along(size_.width)),
                      static_cast<GLuint>(groups_along(size_.height)), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> partial(sums_.groups);
    glGetNamedBufferSubData(sums_.buffer.name(), 0, static_cast<GLsizeiptr>(sums_.groups * sizeof(glm::vec4)),
                            partial.data());
    glm::dvec4 sum(0);
    for (const glm::vec4& group : partial)
        sum += glm::dvec4(group);
    return {sum.y > 0 ? std::sqrt(sum.x / sum.y) : 0, sum.z > 0 ? sum.w / sum.z : 0, sum.z};
}

prt::Image FrameRenderer::read(int index, std::vector<float>* alpha) const {
    const Side& side = sides_[static_cast<std::size_t>(index)];
    prt::Image image{size_.width * size_.samples, size_.height * size_.samples, {}};
    std::vector<glm::vec4> rgba(pixels());
    glGetTextureImage(side.color.name(), 0, GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(rgba.size() * sizeof(glm::vec4)), rgba.data());
    prt::check_gl("reading the picture back");
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x) {
            const glm::vec4& pixel =
                rgba[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(x)];
            image.pixels.emplace_back(pixel);
            if (alpha)
                alpha->push_back(pixel.a);
        }
    return image;
}

std::vector<std::uint8_t> FrameRenderer::read_gbuffer_occlusion() const {
    std::vector<std::uint8_t> rgba(4 * pixels()), occlusion;
    glGetTextureImage(gbuffer_.base.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()),
                      rgba.data());
    for (std::size_t i = 0; i < pixels(); ++i)
        occlusion.push_back(rgba[4 * i + 3] >> 3);
    return occlusion;
}

std::vector<float> FrameRenderer::read_ssao() const {
    std::vector<float> values(pixels());
    glGetTextureImage(ssao_.textures[1].name(), 0, GL_RED, GL_FLOAT,
                      static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

} // namespace viewer
