#pragma once

// Draws pictures of a model into textures, linear and half precision, and puts them on the screen.

#include "pictures/gpu_model.h"
#include "pictures/moving_stage.h"
#include "pictures/settings.h"

#include "prt/gl_scene.h"

#include <array>

namespace viewer {

/// What a frame shows beside the settings.
struct FrameView {
    prt::Camera camera;
    float exposure = 1;
    const prt::GlObject* background = nullptr; ///< lat-long; null: black
    float background_rotation = 0;             ///< radians
    MovingStage* moving = nullptr;             ///< null: nothing moves
};

/// How two pictures differ over the pixels where both show a surface.
struct Difference {
    double relative_l2 = 0; ///< root of the squared difference over the squared second picture, all channels
    double mean = 0;        ///< radiance of the second picture
    double pixels = 0;
};

/// Of a screen, in pixels.
struct FrameSize {
    int width = 0, height = 0, samples = 1; ///< per pixel along each axis

    friend bool operator==(const FrameSize&, const FrameSize&) = default;
};

/// [first, last) of a screen.
struct Columns {
    int first, last;
};

class FrameRenderer {
public:
    FrameRenderer();

    /// Makes targets anew where the size changes.
    void resize(const FrameSize& size);

    /// Draws into side 0 (left) or 1 (right). Only `columns` need be right. `kind` is not the reference.
    void draw(int side, PictureKind kind, GpuModel& model, const DrawSettings& settings,
              const FrameView& view, const Columns& columns);
    /// Over a side as it was drawn last: the texels of the lightmap that `model` has, of the same surface.
    void draw_texel_grid(int side, PictureKind kind, GpuModel& model, const DrawSettings& settings,
                         const FrameView& view, const Columns& columns);
    /// Side `side` shows this image instead, of any size; `surfaces` goes to alpha.
    void show(int side, const prt::Image& image, const std::vector<bool>& surfaces);
    /// The vertex stage alone: nothing is rasterised.
    void draw_vertices_only(PictureKind kind, GpuModel& model, const DrawSettings& settings,
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
    enum class Pass { background, ssao, ssao_blur, deferred, composite, difference };
    struct Side {
        prt::GlObject color, depth, framebuffer, color_only;
        prt::GlObject shown; ///< an image in place of `color`
        bool shows_image = false;
    };
    struct GBuffer {
        prt::GlObject base, normal, radiance;
        std::array<prt::GlObject, 2> framebuffers; ///< [sides]
    };
    struct SsaoTargets {
        std::array<prt::GlObject, 2> textures, framebuffers; ///< as found; blurred
    };
    struct Sums {
        prt::GlObject buffer;
        std::size_t groups = 0;
    };
    const prt::GlObject& program(Pass pass) const { return programs_[static_cast<std::size_t>(pass)]; }
    GeometryPass geometry_pass(const GpuModel& model, const DrawSettings& settings,
                               const FrameView& view) const;
    void scissor(const Columns& columns) const;
    void clear(const Side& side, PictureKind kind, const Columns& columns) const;
    void draw_background(const Side& side, const FrameView& view) const;
    void draw_moving(const GpuModel& model, const GeometryPass& pass, const FrameView& view) const;
    void draw_deferred(int side, PictureKind kind, GpuModel& model, GeometryPass pass,
                       const DrawSettings& settings, const FrameView& view) const;
    void draw_ssao(const Side& side, PictureKind kind, const SsaoSettings& settings, const FrameView& view,
                   const GpuModel& model) const;
    void light_gbuffer(const Side& side, const GpuModel& model, PictureKind kind) const;
    void bind_side_textures() const;
    void fill_screen() const;
    std::size_t pixels() const;

    FrameSize size_;
    std::array<prt::GlObject, 6> programs_; ///< [Pass]
    prt::GlObject no_vertices_;
    std::array<Side, 2> sides_;
    GBuffer gbuffer_;
    SsaoTargets ssao_;
    Sums sums_; ///< of the difference
};

} // namespace viewer
