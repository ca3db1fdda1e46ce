#pragma once

// The viewer without a window. Panels, keys and scripts change its public members and call its functions; the
// owner of the OpenGL context draws it.

#include "core/frame_statistics.h"
#include "core/hovered.h"
#include "core/jobs.h"
#include "core/orbit_camera.h"
#include "core/reference.h"
#include "core/screen.h"
#include "core/viewer_light.h"
#include "gpu/gpu_timer.h"
#include "gpu/mesh_renderer.h"
#include "pictures/frame_renderer.h"
#include "pictures/gpu_model.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace viewer {

class Viewer {
public:
    /// Requires a current OpenGL 4.5 context, as does every function that draws.
    Viewer();

    /// Opens models and environment maps; shows a message for other files. Returns at once, because files are
    /// read in the background. A bake and its compressed transfer are shown together, also if one of them is
    /// already open.
    void open(const std::vector<std::filesystem::path>& paths);
    /// Opens a file in the background as the figure that walks through the scene.
    void open_figure(const std::filesystem::path& path);
    /// Throws `prt::Error` if there is no figure, or if it does not have this animation.
    void choose_figure(const FigureChoice& choice);
    /// Advances the figure by `seconds` at once.
    void walk_figure(double seconds);
    /// Bakes the model again, even if it already has transfer.
    void bake_anew();
    /// True if the error over the surface can be measured: there is a bake of vertices.
    bool can_measure() const {
        return document_.raw() && !document_.loaded.of_texels() && !jobs_.busy(JobKind::model);
    }
    /// True if the model can be baked. The viewer bakes vertices only.
    bool can_bake() const { return document_.model() && !document_.loaded.of_texels() && !jobs_.busy(); }
    /// Measures the budget in the background, under the current light.
    void measure_budget();
    void stop_budget() { jobs_.stop(JobKind::budget); }
    /// True if the last budget belongs to the current light and transfer.
    bool budget_is_current() const { return document_.budget && document_.budget->version == lampless(); }
    /// True if there is compressed transfer to save.
    bool can_save() const { return document_.compressed() && !jobs_.busy(JobKind::saving); }
    /// Writes the model with its compressed transfer in the background; a message reports the path or the
    /// error. If `output` is empty, a free name next to the model is used.
    void save(std::filesystem::path output = {});
    /// Shows the whole model, as after opening it.
    void reset_camera();
    /// Selects one of `lighting().environments`.
    void use_environment(std::size_t index);

    Settings settings;
    CompressionSettings compression; ///< if these settings differ from the compressed transfer, it is
                                     ///< compressed again in the background
    OrbitCamera camera;
    LightSettings lights; ///< applied by `update`

    /// Applies the findings of the background jobs, and advances time by `seconds`.
    void update(double seconds);
    /// Draws the frame without panels. Throws `prt::Error` if the device cannot draw it.
    void draw(std::uint32_t framebuffer, int width, int height);
    /// Sets the pixel under the pointer; empty if the pointer is outside.
    void hover(std::optional<glm::vec2> pixel) { seen_.pointer = pixel; }

    const Document& document() const { return document_; }
    const Jobs& jobs() const { return jobs_; }
    const ViewerLight& lighting() const { return lighting_; }
    const Figures& figures() const { return statistics_.figures; }
    void forget_longest() { statistics_.figures.milliseconds.longest = 0; }
    const std::optional<Hovered>& hovered() const { return seen_.hovered; }
    Screen screen() const { return {camera.camera(), glm::vec2(seen_.size)}; }
    FrameRenderer& renderer() { return gpu_->renderer; }

    /// Messages, newest last; shown until they are dismissed.
    const std::deque<std::string>& messages() const { return messages_; }
    void message(const std::string& text);
    void dismiss_messages() { messages_.clear(); }

    /// The picture shown on one side: the wanted one, or its substitute until it is available. `note` is the
    /// reason for a substitute, or names the light that is missing in the picture.
    struct Shown {
        PictureKind kind;
        std::string note;
    };
    Shown shown(const SidePicture& wanted) const;
    /// Returns the reason if no side can ever show this picture for the open models; empty if one can.
    std::string never_shown(const SidePicture& wanted) const;

    /// Frees all GPU objects after the context is lost; call `restore_gpu` with another context.
    void release_gpu() { gpu_.reset(); }
    void restore_gpu();

private:
    struct Gpu {
        FrameRenderer renderer;
        std::unique_ptr<GpuModel> model, beside; ///< models of the document
        prt::GlObject background;
        std::uint64_t background_version = 0;
        RadianceVersion lit, numbers, budget; ///< versions of the light on the model, of the requested
                                              ///< numbers, of the requested budget
        GpuTimer frame, vertices;
        MeshRenderer meshes;
        MovingStage moving;
    };
    /// State of the screen in the last frame.
    struct Seen {
        glm::ivec2 size{1};
        std::optional<glm::vec2> pointer;
        std::optional<Hovered> hovered;
    };
    void take(const OpenModels& models);
    void take(const Baked& baked);
    void take(const Compressed& compressed);
    void take(const Occlusion& occlusion);
    void take(const OpenedEnvironment& file);
    void take(const NumberPictures& pictures);
    void take(const RepeatedBake& repeated);
    void take(const SurfaceBudget& budget);
    void take(const SortedFiles& sorted);
    void take(const FigureFile& file);
    void take(const FoundOccluders& found);
    void take(const FoundVolume& found);
    void take(const Saved& saved);
    void take(const Failure& failure);
    void open_scenes(const std::vector<std::filesystem::path>& paths);
    void follow_moving(double seconds);
    void upload_moving();
    void upload_models();
    std::unique_ptr<GpuModel> uploaded(const LoadedModel& loaded);
    /// Returns the GPU model of a model of the document; null if it has none.
    GpuModel* gpu_model(const Model* model) const;
    GpuModel& gpu_model(const SidePicture& picture) const;
    void recompress_where_asked();
    void follow_lamps();
    RadianceVersion version() const {
        return {document_.transfer_version, lighting_.rig.version(), lighting_.lamps_version(),
                settings.lit.separate_suns};
    }
    /// Returns the version that a budget depends on: without lamps.
    RadianceVersion lampless() const {
        RadianceVersion lampless = version();
        lampless.lamps = 0;
        return lampless;
    }
    const SeparateLight& light() {
        return lighting_.light_for_pictures(document_.light_order(), settings.lit.separate_suns);
    }
    bool wants(PictureKind kind) const { return settings.left == kind || settings.right == kind; }

    void follow_light();
    std::string left_out(const SidePicture& picture) const;
    void find_numbers();
    void follow_budget();
    FrameView frame_view();
    void draw_sides(const std::array<SidePicture, 2>& pictures, const FrameView& view);
    void show_reference(int side, const FrameView& view);
    void draw_lobe(std::uint32_t framebuffer, const FrameView& view);
    SidePicture under_pointer() const;
    void measure(const SidePicture& right, const FrameView& view);

    Document document_;
    Jobs jobs_;
    ViewerLight lighting_;
    Reference reference_;
    FrameStatistics statistics_;
    std::deque<std::string> messages_;
    Seen seen_;
    std::unique_ptr<Gpu> gpu_;
};

} // namespace viewer
