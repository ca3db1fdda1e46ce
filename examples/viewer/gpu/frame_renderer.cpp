#include "gpu/frame_renderer.h"

#include "prt/support/error.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace viewer {
namespace {

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
        throw prt::Error("this device cannot draw into the textures that the viewer needs");
    return framebuffer;
}

bool is_ssao(PictureKind kind) {
    return kind == PictureKind::ssao || kind == PictureKind::ssao_normals;
}

} // namespace

void FrameRenderer::resize(int width, int height, int samples) {
    if (width == width_ && height == height_ && samples == samples_)
        return;
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (width * samples > largest || height * samples > largest)
        throw prt::Error("this device draws pictures of at most " + std::to_string(largest) +
                         " pixels along a side");
    const int w = width * samples, h = height * samples;
    base_ = make_target(GL_SRGB8_ALPHA8, w, h);
    normal_ = make_target(GL_RG16, w, h);
    radiance_ = make_target(GL_RGBA16F, w, h);
    for (std::size_t i = 0; i < 2; ++i) {
        Side& side = sides_[i];
        side.color = make_target(GL_RGBA16F, w, h);
        side.depth = make_target(GL_DEPTH_COMPONENT32F, w, h);
        side.framebuffer = make_framebuffer({&side.color}, &side.depth);
        side.color_only = make_framebuffer({&side.color}, nullptr);
        gbuffer_[i] = make_framebuffer({&base_, &normal_, &radiance_}, &side.depth);
        ssao_[i] = make_target(GL_R16F, w, h);
        ssao_framebuffer_[i] = make_framebuffer({&ssao_[i]}, nullptr);
    }
    if (empty_.name() == 0) {
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        empty_ = prt::GlObject(prt::GlKind::vertex_array, name);
        sums_program_ = prt::make_compute_program("viewer_difference.comp");
    }
    groups_ = static_cast<std::size_t>((width + 15) / 16) * static_cast<std::size_t>((height + 15) / 16);
    sums_ = prt::make_buffer(std::span<const glm::vec4>(std::vector<glm::vec4>(groups_)));
    width_ = width;
    height_ = height;
    samples_ = samples;
}

const prt::GlObject& FrameRenderer::program(const char* fragment) {
    prt::GlObject& program = programs_[fragment];
    if (program.name() == 0)
        program = prt::make_program("background.vert", fragment);
    return program;
}

void FrameRenderer::fill_screen() const {
    glBindVertexArray(empty_.name());
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FrameRenderer::draw_background(const FrameView& view) const {
    const prt::GlObject& background = programs_.at("background.frag");
    const prt::CameraFrame frame = prt::camera_frame(view.camera);
    const double aspect = static_cast<double>(width_) / height_;
    const glm::vec3 forward(frame.forward), right(frame.right * (frame.half_height * aspect)),
        up(frame.up * frame.half_height);
    glUseProgram(background.name());
    glUniform3fv(prt::uniform(background, "forward"), 1, glm::value_ptr(forward));
    glUniform3fv(prt::uniform(background, "right"), 1, glm::value_ptr(right));
    glUniform3fv(prt::uniform(background, "up"), 1, glm::value_ptr(up));
    glUniform1f(prt::uniform(background, "rotation"), view.background_rotation);
    glBindTextureUnit(PRT_UNIT_BACKGROUND, view.background->name());
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE); // alpha says where surfaces are
    fill_screen();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

namespace {

GeometryPass make_pass(const GpuModel& model, const Settings& settings, const FrameView& view, float aspect) {
    GeometryPass pass;
    pass.view_projection = prt::view_projection(view.camera, model.model().box, aspect);
    pass.eye = view.camera.position;
    pass.culling = settings.culling;
    pass.textured = settings.textured;
    pass.dithered = settings.dithered;
    return pass;
}

} // namespace

void FrameRenderer::draw(int index, PictureKind kind, GpuModel& model, const Settings& settings,
                         const FrameView& view, int first, int last) {
    Side& side = sides_[static_cast<std::size_t>(index)];
    side.shows_image = false;
    GeometryPass pass =
        make_pass(model, settings, view, static_cast<float>(width_) / static_cast<float>(height_));
    const bool numbers = shows_numbers(kind), ssao = is_ssao(kind);
    const bool deferred = !numbers && (settings.deferred || ssao);
    glViewport(0, 0, width_ * samples_, height_ * samples_);
    glScissor(first * samples_, 0, std::max(0, last - first) * samples_, height_ * samples_);
    glEnable(GL_SCISSOR_TEST);

    constexpr float kNothing[4] = {0, 0, 0, 0}, kFar = 1;
    glClearNamedFramebufferfv(side.framebuffer.name(), GL_COLOR, 0, kNothing);
    if (ssao) // looks beyond the columns that are asked for
        glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(side.framebuffer.name(), GL_DEPTH, 0, &kFar);
    if (settings.background && view.background && !numbers) {
        program("background.frag");
        glEnable(GL_SCISSOR_TEST);
        glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
        draw_background(view);
        if (ssao)
            glDisable(GL_SCISSOR_TEST);
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    if (deferred) {
        glBindFramebuffer(GL_FRAMEBUFFER, gbuffer_[index].name());
        glEnable(GL_FRAMEBUFFER_SRGB);
        pass.gbuffer = true;
        model.draw_opaque(kind, pass);
        glDisable(GL_FRAMEBUFFER_SRGB);
        glEnable(GL_SCISSOR_TEST);
        if (ssao)
            draw_ssao(side, kind, settings, view, pass.view_projection, model.model().radius);
        program("viewer_deferred.frag");
        light_gbuffer(side, model, ssao);
        glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
        glEnable(GL_DEPTH_TEST);
    } else {
        glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
        model.draw_opaque(kind, pass);
    }
    model.draw_blended(kind, pass);
    if (settings.wireframe)
        model.draw_wires(pass, glm::vec3(numbers ? 0.1f : 0.15f / view.exposure));
    glDisable(GL_SCISSOR_TEST);
    prt::check_gl("drawing");
}

void FrameRenderer::draw_ssao(const Side& side, PictureKind kind, const Settings& settings,
                              const FrameView& view, const glm::mat4& matrix, float scene_radius) {
    const glm::mat4 inverse(glm::inverse(glm::dmat4(matrix)));
    const glm::vec3 forward(prt::camera_frame(view.camera).forward);
    const float radius = settings.ssao.radius * scene_radius;
    glBindTextureUnit(PRT_UNIT_GBUFFER_NORMAL, normal_.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_DEPTH, side.depth.name());
    for (const char* fragment : {"viewer_ssao.frag", "viewer_ssao_blur.frag"}) {
        const bool blur = std::string_view(fragment) == "viewer_ssao_blur.frag";
        const prt::GlObject& ssao = program(fragment);
        glBindFramebuffer(GL_FRAMEBUFFER, ssao_framebuffer_[blur ? 1 : 0].name());
        glUseProgram(ssao.name());
        glUniformMatrix4fv(prt::uniform(ssao, "view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
        glUniformMatrix4fv(prt::uniform(ssao, "inverse_view_projection"), 1, GL_FALSE,
                           glm::value_ptr(inverse));
        glUniform3fv(prt::uniform(ssao, "eye"), 1, glm::value_ptr(view.camera.position));
        glUniform3fv(prt::uniform(ssao, "forward"), 1, glm::value_ptr(forward));
        glUniform1f(prt::uniform(ssao, "radius"), radius);
        glUniform1f(prt::uniform(ssao, "bias"), settings.ssao.bias);
        glUniform1f(prt::uniform(ssao, "intensity"), settings.ssao.intensity);
        glUniform1i(prt::uniform(ssao, "pairs"), std::max(1, settings.ssao.samples / 2));
        glUniform1i(prt::uniform(ssao, "use_normals"), kind == PictureKind::ssao_normals);
        if (blur)
            glBindTextureUnit(PRT_UNIT_SSAO, ssao_[0].name());
        fill_screen();
    }
}

void FrameRenderer::light_gbuffer(const Side& side, GpuModel& model, bool with_ssao) const {
    const prt::GlObject& deferred = programs_.at("viewer_deferred.frag");
    glBindFramebuffer(GL_FRAMEBUFFER, side.color_only.name());
    glUseProgram(deferred.name());
    glUniform3fv(prt::uniform(deferred, "irradiance_sh"), 9, glm::value_ptr(model.irradiance()[0]));
    glUniform1i(prt::uniform(deferred, "has_ssao"), with_ssao);
    glBindTextureUnit(PRT_UNIT_GBUFFER_BASE, base_.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_NORMAL, normal_.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_RADIANCE, radiance_.name());
    glBindTextureUnit(PRT_UNIT_GBUFFER_DEPTH, side.depth.name());
    glBindTextureUnit(PRT_UNIT_SSAO, ssao_[1].name());
    fill_screen();
}

void FrameRenderer::show(int index, const prt::Image& image, const std::vector<bool>& surfaces) {
    Side& side = sides_[static_cast<std::size_t>(index)];
    std::vector<glm::vec4> pixels;
    pixels.reserve(image.pixels.size());
    for (int y = image.height - 1; y >= 0; --y) // OpenGL's rows start at the bottom
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

void FrameRenderer::draw_vertices_only(PictureKind kind, GpuModel& model, const Settings& settings,
                                       const FrameView& view) {
    glBindFramebuffer(GL_FRAMEBUFFER, sides_[0].framebuffer.name());
    glEnable(GL_RASTERIZER_DISCARD);
    model.draw_opaque(
        kind, make_pass(model, settings, view, static_cast<float>(width_) / static_cast<float>(height_)));
    glDisable(GL_RASTERIZER_DISCARD);
}

void FrameRenderer::bind_side_textures() const {
    for (unsigned i = 0; i < 2; ++i)
        glBindTextureUnit(PRT_UNIT_LEFT + i,
                          (sides_[i].shows_image ? sides_[i].shown : sides_[i].color).name());
}

void FrameRenderer::composite(std::uint32_t framebuffer, const Settings& settings, const FrameView& view,
                              const std::array<PictureKind, 2>& kinds, double mean) {
    const prt::GlObject& composite = program("viewer_composite.frag");
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width_, height_);
    glUseProgram(composite.name());
    glUniform2i(prt::uniform(composite, "size"), width_, height_);
    glUniform1f(prt::uniform(composite, "split"), std::round(settings.split * static_cast<float>(width_)));
    glUniform2i(prt::uniform(composite, "tone_mapped"), !shows_numbers(kinds[0]), !shows_numbers(kinds[1]));
    glUniform1f(prt::uniform(composite, "exposure"), view.exposure);
    glUniform1i(prt::uniform(composite, "difference"), settings.difference);
    glUniform1f(prt::uniform(composite, "white"), settings.white * static_cast<float>(std::max(mean, 1e-30)));
    bind_side_textures();
    fill_screen();
    prt::check_gl("drawing");
}

Difference FrameRenderer::difference() {
    glUseProgram(sums_program_.name());
    glUniform2i(prt::uniform(sums_program_, "size"), width_, height_);
    bind_side_textures();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_SUMS, sums_.name());
    glDispatchCompute(static_cast<GLuint>((width_ + 15) / 16), static_cast<GLuint>((height_ + 15) / 16), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<glm::vec4> partial(groups_);
    glGetNamedBufferSubData(sums_.name(), 0, static_cast<GLsizeiptr>(groups_ * sizeof(glm::vec4)),
                            partial.data());
    glm::dvec4 sum(0);
    for (const glm::vec4& group : partial)
        sum += glm::dvec4(group);
    return {sum.y > 0 ? std::sqrt(sum.x / sum.y) : 0, sum.z > 0 ? sum.w / sum.z : 0, sum.z};
}

prt::Image FrameRenderer::read(int index, std::vector<float>* alpha) const {
    const Side& side = sides_[static_cast<std::size_t>(index)];
    prt::Image image{width_ * samples_, height_ * samples_, {}};
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(image.width) *
                                  static_cast<std::size_t>(image.height));
    glGetTextureImage(side.color.name(), 0, GL_RGBA, GL_FLOAT,
                      static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)), pixels.data());
    prt::check_gl("reading the picture back");
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x) {
            const glm::vec4& pixel =
                pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x)];
            image.pixels.emplace_back(pixel);
            if (alpha)
                alpha->push_back(pixel.a);
        }
    return image;
}

std::vector<std::uint8_t> FrameRenderer::read_gbuffer_occlusion() const {
    const auto count =
        static_cast<std::size_t>(width_ * samples_) * static_cast<std::size_t>(height_ * samples_);
    std::vector<std::uint8_t> rgba(4 * count), occlusion;
    glGetTextureImage(base_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()),
                      rgba.data());
    for (std::size_t i = 0; i < count; ++i)
        occlusion.push_back(rgba[4 * i + 3] >> 3);
    return occlusion;
}

std::vector<float> FrameRenderer::read_ssao() const {
    std::vector<float> values(static_cast<std::size_t>(width_ * samples_) *
                              static_cast<std::size_t>(height_ * samples_));
    glGetTextureImage(ssao_[1].name(), 0, GL_RED, GL_FLOAT,
                      static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
    return values;
}

} // namespace viewer
