#pragma once

// Draws pictures of a model into textures (linear, half precision) and composites them on the screen.

#include "pictures/gpu_model.h"
#include "pictures/moving_stage.h"
#include "pictures/settings.h"

#include "runtime/render/gl/gl_scene.h"

#include <array>

namespace viewer {

/// View of a frame, in addition to the settings.
struct FrameView {
    prt::Camera camera;
    float exposure = 1;
    const prt::GlObject* background = nullptr; ///< lat-long; null: black
    float background_rotation = 0;             ///< radians
    MovingStage* moving = nullptr;             ///< null: there are no moving objects
};

/// Difference of two pictures over the pixels where both show a surface.
struct Difference {
    double relative_l2 = 0; ///< square root of the summed squared difference over the summed squared second
                            ///< picture, all channels
    double mean = 0;        ///< mean radiance of the second picture
    double pixels = 0;
};

/// Size of a screen, in pixels.
struct FrameSize {
    int width = 0, height = 0, samples = 1; ///< per pixel along each axis

    friend bool operator==(const FrameSize&, const FrameSize&) = default;
};

/// Range [first, last) of pixel columns of a screen.
struct Columns {
    int first, last;
};

class FrameRenderer {
public:
    FrameRenderer();

    /// Recreates the targets if the size changes.
    void resize(const FrameSize& size);

    /// Draws into side 0 (left) or 1 (right). Only `columns` need to be correct. `kind` must not be the
    /// reference.
    void draw(int side, PictureKind kind, GpuModel& model, const DrawSettings& settings,
              const FrameView& view, const Columns& columns);
    /// Draws the texel borders of the lightmap of `model` over the last picture of a side, which must show
    /// the same surface.
    void draw_texel_grid(int side, PictureKind kind, GpuModel& model, const DrawSettings& settings,
                         const FrameView& view, const Columns& columns);
    /// Shows this image on a side instead, at any size; `surfaces` becomes its alpha.
    void show(int side, const prt::Image& image, const std::vector<bool>& surfaces);
    /// Runs only the vertex stage, without rasterisation.
    void draw_vertices_only(PictureKind kind, GpuModel& model, const DrawSettings& settings,
                            const FrameView& view);

    /// Draws both sides, or their difference, to `framebuffer`. `mean` is the radiance that the difference is
    /// relative to.
    void composite(std::uint32_t framebuffer, const Settings& settings, const FrameView& view,
                   const std::array<PictureKind, 2>& kinds, double mean);
    /// Returns the difference of the last pictures of the sides; waits for the GPU.
    Difference difference();

    /// Reads back linear radiance, [height · samples][width · samples], and alpha.
    prt::Image read(int side, std::vector<float>* alpha = nullptr) const;
    /// Reads back the ambient occlusion of the G-buffer (0..31) and of SSAO: [height · samples][width ·
    /// samples], rows from the bottom. For tests.
    std::vector<std::uint8_t> read_gbuffer_occlusion() const;
    std::vector<float> read_ssao() const;

private:
    enum class Pass { background, ssao, ssao_blur, deferred, composite, difference };
    struct Side {
        prt::GlObject color, depth, framebuffer, color_only;
        prt::GlObject shown; ///< image that replaces `color`
        bool shows_image = false;
    };
    struct GBuffer {
        prt::GlObject base, normal, radiance;
        std::array<prt::GlObject, 2> framebuffers; ///< [sides]
    };
    struct SsaoTargets {
        std::array<prt::GlObject, 2> textures, framebuffers; ///< [raw; blurred]
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
    Sums sums_; ///< sums for the difference
};

} // namespace viewer
