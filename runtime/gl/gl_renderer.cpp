#include "prt/gl_renderer.h"

#include "prt/error.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <optional>
#include <string>

namespace prt {
namespace {

GLint uniform(const GlObject& program, const char* name) {
    return glGetUniformLocation(program.name(), name);
}

GLint wrap_mode(Wrap wrap) {
    switch (wrap) {
    case Wrap::clamp:
        return GL_CLAMP_TO_EDGE;
    case Wrap::mirror:
        return GL_MIRRORED_REPEAT;
    case Wrap::repeat:
        break;
    }
    return GL_REPEAT;
}

GlObject make_texture_2d(int levels, GLenum format, int width, int height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlObject texture(GlKind::texture, name);
    glTextureStorage2D(name, levels, format, width, height);
    check_gl("a texture");
    return texture;
}

/// Colour and depth, both float, as large as the samples of the picture.
struct Target {
    GlObject color, depth, framebuffer;
    int width, height;

    explicit Target(const Picture& picture)
        : width(picture.width * picture.samples), height(picture.height * picture.samples) {
        GLint largest = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
        if (width > largest || height > largest)
            throw Error("the picture with its samples is " + std::to_string(width) + " x " +
                        std::to_string(height) + ", but this device draws at most " +
                        std::to_string(largest) + " x " + std::to_string(largest));
        color = make_texture_2d(1, GL_RGBA32F, width, height);
        depth = make_texture_2d(1, GL_DEPTH_COMPONENT32F, width, height);
        GLuint name = 0;
        glCreateFramebuffers(1, &name);
        framebuffer = GlObject(GlKind::framebuffer, name);
        glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, color.name(), 0);
        glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth.name(), 0);
        if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw Error("this device cannot draw into float textures");
    }

    Image read() const {
        Image image{width, height, {}};
        image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, width, height, GL_RGB, GL_FLOAT, image.pixels.data());
        check_gl("reading the picture back");
        for (int y = 0; y < height / 2; ++y) // OpenGL's rows start at the bottom
            std::swap_ranges(&image.at(0, y), &image.at(0, y) + width, &image.at(0, height - 1 - y));
        return image;
    }
};

/// One vertex array of the scene on the GPU.
struct GlVertices {
    GlObject positions, texcoords, colors, radiance, vertex_array;
    int texcoord_set = -1;
};

void attach_floats(const GlObject& vertex_array, const GlObject& buffer, GLuint location, int components) {
    const auto size = static_cast<GLsizei>(sizeof(float) * static_cast<std::size_t>(components));
    glVertexArrayVertexBuffer(vertex_array.name(), location, buffer.name(), 0, size);
    glEnableVertexArrayAttrib(vertex_array.name(), location);
    glVertexArrayAttribFormat(vertex_array.name(), location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vertex_array.name(), location, location);
}

class GlRenderer {
public:
    explicit GlRenderer(const Picture& picture) : picture_(picture), target_(picture) {
        if (picture.transfer) {
            transfer_.emplace(*picture.transfer);
            transfer_->set_light(*picture.light);
        }
        program_ = make_program("scene.vert", "scene.frag", transfer_ ? transfer_->defines() : "");
        for (const Texture& texture : picture.textures)
            textures_.push_back(upload(texture));
        for (const VertexArray& vertices : picture.scene->vertex_arrays)
            vertices_.push_back(upload(vertices));
    }

    Image render() {
        glBindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer.name());
        glViewport(0, 0, target_.width, target_.height);
        constexpr float kBlack[4] = {0, 0, 0, 1}, kFar = 1;
        glClearNamedFramebufferfv(target_.framebuffer.name(), GL_COLOR, 0, kBlack);
        glClearNamedFramebufferfv(target_.framebuffer.name(), GL_DEPTH, 0, &kFar);
        draw_background();
        set_common_uniforms();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        draw_primitives();
        check_gl("drawing");
        return target_.read();
    }

private:
    GlObject upload(const Texture& texture) const {
        if (texture.levels.empty())
            return {};
        const Image8& base = texture.levels[0];
        GlObject object = make_texture_2d(static_cast<int>(texture.levels.size()), GL_SRGB8_ALPHA8,
                                          base.width, base.height);
        for (std::size_t level = 0; level < texture.levels.size(); ++level) {
            const Image8& image = texture.levels[level];
            glTextureSubImage2D(object.name(), static_cast<GLint>(level), 0, 0, image.width, image.height,
                                GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
        }
        glTextureParameteri(object.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        glTextureParameteri(object.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        return object;
    }

    GlVertices upload(const VertexArray& vertices) const {
        GlVertices result;
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        result.vertex_array = GlObject(GlKind::vertex_array, name);
        result.positions = make_buffer(std::span<const glm::vec3>(vertices.positions));
        attach_floats(result.vertex_array, result.positions, PRT_LOCATION_POSITION, 3);
        if (!vertices.colors.empty()) {
            result.colors = make_buffer(std::span<const glm::vec4>(vertices.colors));
            attach_floats(result.vertex_array, result.colors, PRT_LOCATION_COLOR, 4);
        }
        if (transfer_) {
            transfer_->attach(name, vertices.first_receiver);
        } else {
            result.radiance =
                make_buffer(picture_.radiance.subspan(vertices.first_receiver, vertices.size()));
            attach_floats(result.vertex_array, result.radiance, PRT_LOCATION_RADIANCE, 3);
        }
        return result;
    }

    void draw_background() const {
        if (!picture_.background)
            return;
        const Image& image = *picture_.background;
        const GlObject texture = make_texture_2d(1, GL_RGB32F, image.width, image.height);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT,
                            image.pixels.data());
        glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        const GlObject program = make_program("background.vert", "background.frag");
        const CameraFrame frame = camera_frame(picture_.camera);
        const double aspect = static_cast<double>(picture_.width) / picture_.height;
        const glm::vec3 forward(frame.forward), right(frame.right * (frame.half_height * aspect)),
            up(frame.up * frame.half_height);
        glUseProgram(program.name());
        glUniform3fv(uniform(program, "forward"), 1, glm::value_ptr(forward));
        glUniform3fv(uniform(program, "right"), 1, glm::value_ptr(right));
        glUniform3fv(uniform(program, "up"), 1, glm::value_ptr(up));
        glUniform1f(uniform(program, "rotation"), picture_.background_rotation);
        glBindTextureUnit(PRT_UNIT_BACKGROUND, texture.name());
        GLuint empty = 0;
        glCreateVertexArrays(1, &empty);
        const GlObject vertex_array(GlKind::vertex_array, empty);
        glBindVertexArray(empty);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    void set_common_uniforms() const {
        glUseProgram(program_.name());
        const float aspect = static_cast<float>(picture_.width) / static_cast<float>(picture_.height);
        const glm::mat4 matrix = view_projection(picture_.camera, bounds(*picture_.scene), aspect);
        glUniformMatrix4fv(uniform(program_, "view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
        glUniform1i(uniform(program_, "textured"), picture_.textured);
        glVertexAttrib4f(PRT_LOCATION_COLOR, 1, 1, 1, 1); // where there is no array
        glVertexAttrib2f(PRT_LOCATION_TEXCOORD, 0, 0);
        if (transfer_)
            transfer_->use();
    }

    bool is_blended(const Primitive& primitive) const {
        return picture_.textured &&
               picture_.scene->materials[primitive.material].alpha_mode == AlphaMode::blend;
    }

    float distance(const Primitive& primitive) const {
        const VertexArray& vertices = picture_.scene->vertex_arrays[primitive.vertices];
        glm::vec3 sum(0);
        for (const glm::uvec3& t : primitive.triangles)
            sum += vertices.positions[t.x];
        return glm::distance(picture_.camera.position,
                             sum / static_cast<float>(std::max<std::size_t>(1, primitive.triangles.size())));
    }

    void draw_primitives() {
        std::vector<const Primitive*> blended;
        for (const Primitive& primitive : picture_.scene->primitives) {
            if (is_blended(primitive))
                blended.push_back(&primitive);
            else
                draw(primitive);
        }
        std::stable_sort(blended.begin(), blended.end(),
                         [&](const Primitive* a, const Primitive* b) { return distance(*a) > distance(*b); });
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        for (const Primitive* primitive : blended)
            draw(*primitive);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    void attach_texcoords(GlVertices& on_gpu, const VertexArray& vertices, int set) const {
        if (set < 0 || static_cast<std::size_t>(set) >= vertices.texcoords.size() ||
            on_gpu.texcoord_set == set)
            return;
        on_gpu.texcoords =
            make_buffer(std::span<const glm::vec2>(vertices.texcoords[static_cast<std::size_t>(set)]));
        attach_floats(on_gpu.vertex_array, on_gpu.texcoords, PRT_LOCATION_TEXCOORD, 2);
        on_gpu.texcoord_set = set;
    }

    void draw(const Primitive& primitive) {
        const Material& material = picture_.scene->materials[primitive.material];
        const VertexArray& vertices = picture_.scene->vertex_arrays[primitive.vertices];
        GlVertices& on_gpu = vertices_[primitive.vertices];
        const TextureUse& use = material.base_color_texture;
        attach_texcoords(on_gpu, vertices, use.texcoord);
        const bool has_texture = use.image >= 0 && on_gpu.texcoord_set == use.texcoord;
        glUniform1i(uniform(program_, "has_texture"), has_texture);
        glUniform4fv(uniform(program_, "base_color"), 1, glm::value_ptr(material.base_color));
        glUniformMatrix3x2fv(uniform(program_, "texture_transform"), 1, GL_FALSE,
                             glm::value_ptr(use.transform));
        glUniform1i(uniform(program_, "alpha_mode"), static_cast<int>(material.alpha_mode));
        glUniform1f(uniform(program_, "alpha_cutoff"), material.alpha_cutoff);
        if (has_texture) {
            const GLuint texture = textures_[static_cast<std::size_t>(use.image)].name();
            glTextureParameteri(texture, GL_TEXTURE_WRAP_S, wrap_mode(use.wrap_u));
            glTextureParameteri(texture, GL_TEXTURE_WRAP_T, wrap_mode(use.wrap_v));
            glBindTextureUnit(PRT_UNIT_BASE_COLOR, texture);
        }
        if (material.double_sided)
            glDisable(GL_CULL_FACE);
        else
            glEnable(GL_CULL_FACE);
        const GlObject indices = make_buffer(std::span<const glm::uvec3>(primitive.triangles));
        glVertexArrayElementBuffer(on_gpu.vertex_array.name(), indices.name());
        glBindVertexArray(on_gpu.vertex_array.name());
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(primitive.triangles.size() * 3), GL_UNSIGNED_INT,
                       nullptr);
    }

    const Picture& picture_;
    Target target_;
    std::optional<GlTransfer> transfer_;
    GlObject program_;
    std::vector<GlObject> textures_;
    std::vector<GlVertices> vertices_;
};

} // namespace

Image render_gl(const Picture& picture, const GlContext&) {
    return GlRenderer(picture).render();
}

} // namespace prt
