#pragma once

// Draws pictures of a model into textures, linear and half precision, and puts them on the screen.

#include "core/settings.h"
#include "gpu/gpu_model.h"

#include "prt/gl_scene.h"

#include <array>
#include <map>
#include <string>

namespace viewer {

/// What a frame shows beside the settings.
struct FrameView {
    prt::Camera camera;
    float exposure = 1;
    const prt::GlObject* background = nullptr; ///< lat-long; null: black
    float background_rotation = 0;             ///< radians
};

/// How two pictures differ over the pixels where both show a surface.
struct Difference {
    double relative_l2 = 0; ///< root of the squared difference over the squared second picture, all channels
    double mean = 0;        ///< radiance of the second picture
    double pixels = 0;
};

class FrameRenderer {
public:
    /// For a screen of that size. Makes targets anew where it or the samples per pixel change.
    void resize(int width, int height, int samples);

    /// Draws into side 0 (left) or 1 (right). Only the columns [first, last) of the screen need be right.
    /// `kind` is not the reference.
    void draw(int side, PictureKind kind, GpuModel& model, const Settings& settings, const FrameView& view,
              int first, int last);
    /// Side `side` shows this image instead, of any size; `surfaces` goes to alpha.
    void show(int side, const prt::Image& image, const std::vector<bool>& surfaces);
    /// The vertex stage alone: nothing is rasterised.
    void draw_vertices_only(PictureKind kind, GpuModel& model, const Settings& settings,
                            const FrameView& view);

    /// Both sides, or their difference, to `framebuffer`. `mean`: radiance that the difference is relative
    /// to.
    void composite(std::uint32_t framebuffer, const Settings& settings, const FrameView& view,
                   const std::array<PictureKind, 2>& kinds, double mean);
    /// Of the sides as they were drawn last; waits for the GPU.
    Difference difference();

    /// Read back: linear radiance, [height · samples][width · samples], and alpha.
    prt::Image read(int side, std::vector<float>* alpha = nullptr) const;
    /// Ambient occlusion of the G-buffer in 0..31 and of the screen, read back: [height · samples][width ·
    /// samples], rows from the bottom. For tests.
    std::vector<std::uint8_t> read_gbuffer_occlusion() const;
    std::vector<float> read_ssao() const;

private:
    struct Side {
        prt::GlObject color, depth, framebuffer, color_only;
        prt::GlObject shown; ///< an image in place of `color`
        bool shows_image = false;
    };
    void draw_background(const FrameView& view) const;
    void draw_ssao(const Side& side, PictureKind kind, const Settings& settings, const FrameView& view,
                   const glm::mat4& matrix, float scene_radius);
    void light_gbuffer(const Side& side, GpuModel& model, bool with_ssao) const;
    const prt::GlObject& program(const char* fragment);
    void bind_side_textures() const;
    void fill_screen() const;

    int width_ = 0, height_ = 0, samples_ = 0;
    std::array<Side, 2> sides_;
    prt::GlObject base_, normal_, radiance_, gbuffer_[2];
    prt::GlObject ssao_[2], ssao_framebuffer_[2];
    prt::GlObject empty_;
    prt::GlObject sums_program_, sums_;
    std::size_t groups_ = 0;
    std::map<std::string, prt::GlObject> programs_;
};

} // namespace viewer
