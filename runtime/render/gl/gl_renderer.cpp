// Renders pictures by OpenGL: background, opaque primitives, then blended ones from far to near.

#include "prt/gl/gl_renderer.h"

#include "prt/core/error.h"
#include "runtime/render/gl/gl_relit_textures.h"
#include "runtime/render/gl/gl_scene.h"
#include "runtime/render/gl/gl_transfer.h"
#include "runtime/render/gl/sun_shadows.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <optional>
#include <string>

namespace prt {
namespace {

/// Color and depth buffers, both float, with one pixel per sample of the picture.
struct Target {
    GlObject color, depth, framebuffer;
    int width, height;

    explicit Target(const Picture& picture)
        : width(picture.width * picture.samples), height(picture.height * picture.samples) {
        GLint largest = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
        if (width > largest || height > largest)
            throw Error("the picture with all samples has " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels, but the limit of this device is " +
                        std::to_string(largest) + " x " + std::to_string(largest));
        color = make_texture_2d(1, GL_RGBA32F, width, height);
        depth = make_texture_2d(1, GL_DEPTH_COMPONENT32F, width, height);
        framebuffer = make_framebuffer();
        glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
        glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
        if (glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw Error("this device cannot render to float textures");
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

class GlRenderer {
public:
    explicit GlRenderer(const Picture& picture)
        : picture_(picture), target_(picture), scene_(*picture.scene, picture.textures),
          arrays_(scene_.make_vertex_arrays()) {
        scene_.shine(picture.emission);
        std::string defines;
        if (picture.in_shader.lightmaps.layout) {
            light_by_maps();
            defines = "#define PRT_LIGHTMAP\n";
        } else if (picture.in_shader.transfer) {
            transfer_.emplace(*picture.in_shader.transfer);
            transfer_->set_light({*picture.in_shader.lighting});
            for (std::size_t i = 0; i < arrays_.size(); ++i)
                transfer_->attach(arrays_[i].name(), picture.scene->vertex_arrays[i].first_receiver);
            defines = transfer_->defines();
        }
        std::string suns;
        if (!picture.suns.empty()) {
            shadows_.emplace(scene_);
            suns = "#define PRT_SUNS\n";
        }
        if (defines.empty() || std::ranges::any_of(picture.scene->vertex_arrays, &VertexArray::lobes)) {
            lit_arrays_ = scene_.make_vertex_arrays();
            radiance_ = make_buffer(picture.radiance);
            scene_.attach_receivers(lit_arrays_, radiance_, PRT_LOCATION_RADIANCE, 3);
            lit_program_ = make_program("scene.vert", "scene.frag", suns);
        }
        if (!defines.empty())
            program_ = make_program("scene.vert", "scene.frag", defines + suns);
    }

    Image render() {
        if (shadows_)
            shadows_->draw(picture_.suns, {picture_.camera, picture_.width, picture_.height});
        glBindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer.name());
        glViewport(0, 0, target_.width, target_.height);
        constexpr float kBlack[4] = {0, 0, 0, 1}, kFar = 1;
        glClearNamedFramebufferfv(target_.framebuffer.name(), GL_COLOR, 0, kBlack);
        glClearNamedFramebufferfv(target_.framebuffer.name(), GL_DEPTH, 0, &kFar);
        draw_background();
        for (const GlObject* program : {&program_, &lit_program_})
            if (program->name() != 0)
                set_common_uniforms(*program);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        draw_primitives();
        check_gl("drawing");
        return target_.read();
    }

private:
    void light_by_maps() {
        const PictureLightmaps& lightmaps = picture_.in_shader.lightmaps;
        if (lightmaps.on_gpu) {
            lightmap_.emplace(*lightmaps.on_gpu);
            lightmap_->set_light(*lightmaps.lighting);
            scene_.light_by({&lightmaps.on_gpu->layout, lightmap_->textures()});
        } else {
            maps_ = make_lightmap_textures(*lightmaps.layout, lightmaps.radiance);
            scene_.light_by({lightmaps.layout, maps_});
        }
    }

    void draw_background() const {
        if (!picture_.background.image)
            return;
        const GlObject texture = make_background(*picture_.background.image);
        const GlObject program = make_program("background.vert", "background.frag");
        const CameraFrame frame = camera_frame(picture_.camera);
        const double aspect = static_cast<double>(picture_.width) / picture_.height;
        const glm::vec3 forward(frame.forward), right(frame.right * (frame.half_height * aspect)),
            up(frame.up * frame.half_height);
        glUseProgram(program.name());
        glUniform3fv(uniform(program, "forward"), 1, glm::value_ptr(forward));
        glUniform3fv(uniform(program, "right"), 1, glm::value_ptr(right));
        glUniform3fv(uniform(program, "up"), 1, glm::value_ptr(up));
        set_uniform(program, "rotation", picture_.background.rotation);
        glBindTextureUnit(PRT_UNIT_BACKGROUND, texture.name());
        const GlObject empty = make_vertex_array();
        glBindVertexArray(empty.name());
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    void set_common_uniforms(const GlObject& program) const {
        glUseProgram(program.name());
        const float aspect = static_cast<float>(picture_.width) / static_cast<float>(picture_.height);
        const glm::mat4 matrix = view_projection(picture_.camera, bounds(*picture_.scene), aspect);
        glUniformMatrix4fv(uniform(program, "view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
        glUniform1i(uniform(program, "textured"), picture_.textured);
        if (transfer_)
            transfer_->use();
        if (shadows_)
            shadows_->use();
    }

    /// Draws a primitive by light in the shader, or by the radiance of its vertices.
    void draw(std::size_t p) {
        const bool given = program_.name() == 0 ||
                           picture_.scene->vertex_arrays[picture_.scene->primitives[p].vertices].lobes;
        const GlObject& program = given ? lit_program_ : program_;
        glUseProgram(program.name());
        scene_.draw(program, given ? lit_arrays_ : arrays_, p);
    }

    void draw_primitives() {
        for (std::size_t p = 0; p < picture_.scene->primitives.size(); ++p)
            if (!picture_.textured || !scene_.is_blended(picture_.scene->primitives[p]))
                draw(p);
        if (!picture_.textured)
            return;
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        for (const std::size_t p : scene_.blended_from_far(picture_.camera.position))
            draw(p);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    const Picture& picture_;
    Target target_;
    GlScene scene_;
    GlVertexArrays arrays_;
    std::optional<GlTransfer> transfer_;
    std::optional<GlRelitTextures> lightmap_;
    std::vector<GlObject> maps_;
    std::optional<SunShadows> shadows_;
    GlVertexArrays lit_arrays_; ///< with `radiance_`
    /// `program_` lights by transfer or lightmaps, `lit_program_` shows the radiance of vertices; either may
    /// be empty.
    GlObject radiance_, program_, lit_program_;
};

} // namespace

Image render_gl(const Picture& picture, const GlContext& context) {
    context.make_current();
    return GlRenderer(picture).render();
}

} // namespace prt
