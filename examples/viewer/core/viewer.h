#pragma once

// The viewer without a window: panels, keys and scripts change its public members and call it, whoever owns
// the OpenGL context draws it.

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
    /// An OpenGL 4.5 context must be current, here and in all that draws.
    Viewer();

    /// Models and environment maps; a message for what is neither. At once: files are read in the background.
    /// A bake and what was compressed of it are shown together, be it that one of them is open already.
    void open(const std::vector<std::filesystem::path>& paths);
    /// Opens a file as the figure that walks through the scene, in the background.
    void open_figure(const std::filesystem::path& path);
    /// Throws `prt::Error` where there is no figure, or it has no such animation.
    void choose_figure(const FigureChoice& choice);
    /// It goes on as in so many seconds, at once.
    void walk_figure(double seconds);
    /// Bakes the model anew, though it may hold transfer.
    void bake_anew();
    /// There is a bake of which the error over the surface can be measured: of vertices.
    bool can_measure() const {
        return document_.raw() && !document_.loaded.of_texels() && !jobs_.busy(JobKind::model);
    }
    /// The viewer bakes vertices alone.
    bool can_bake() const { return document_.model() && !document_.loaded.of_texels() && !jobs_.busy(); }
    /// Measures it in the background, under the present light.
    void measure_budget();
    void stop_budget() { jobs_.stop(JobKind::budget); }
    /// The budget that was measured last is of this light and of this transfer.
    bool budget_is_current() const { return document_.budget && document_.budget->version == lampless(); }
    /// There is compressed transfer to save.
    bool can_save() const { return document_.compressed() && !jobs_.busy(JobKind::saving); }
    /// Writes the model with it in the background; a message says where, or why not. `output` empty: beside
    /// the model, under a name that is free.
    void save(std::filesystem::path output = {});
    /// The whole model in view, as it was when it was opened.
    void reset_camera();
    /// Of `lighting().environments`.
    void use_environment(std::size_t index);

    Settings settings;
    CompressionSettings compression; ///< what differs from what is there is compressed in the background
    OrbitCamera camera;
    LightSettings lights; ///< taken over by `update`

    /// Takes in what was found in the background, and lets `seconds` pass.
    void update(double seconds);
    /// The frame, without panels. Throws `prt::Error` where the device cannot.
    void draw(std::uint32_t framebuffer, int width, int height);
    /// The pointer is over this pixel, or nowhere.
    void hover(std::optional<glm::vec2> pixel) { seen_.pointer = pixel; }

    const Document& document() const { return document_; }
    const Jobs& jobs() const { return jobs_; }
    const ViewerLight& lighting() const { return lighting_; }
    const Figures& figures() const { return statistics_.figures; }
    void forget_longest() { statistics_.figures.milliseconds.longest = 0; }
    const std::optional<Hovered>& hovered() const { return seen_.hovered; }
    Screen screen() const { return {camera.camera(), glm::vec2(seen_.size)}; }
    FrameRenderer& renderer() { return gpu_->renderer; }

    /// Newest last; shown until they are dismissed.
    const std::deque<std::string>& messages() const { return messages_; }
    void message(const std::string& text);
    void dismiss_messages() { messages_.clear(); }

    /// What a side shows: what was asked for, or what stands in for it until it is there, and why; or what
    /// it leaves out.
    struct Shown {
        PictureKind kind;
        std::string note;
    };
    Shown shown(const SidePicture& wanted) const;
    /// Why no side can show this of the models that are open, whatever is waited for; empty: one can.
    std::string never_shown(const SidePicture& wanted) const;

    /// The context is gone, with all that was on the GPU; call `restore_gpu` with another one.
    void release_gpu() { gpu_.reset(); }
    void restore_gpu();

private:
    struct Gpu {
        FrameRenderer renderer;
        std::unique_ptr<GpuModel> model, beside; ///< as of the document
        prt::GlObject background;
        std::uint64_t background_version = 0;
        RadianceVersion lit, numbers, budget; ///< that the model is lit by, that were asked for
        GpuTimer frame, vertices;
        MeshRenderer meshes;
        MovingStage moving;
    };
    /// The screen as it was last drawn.
    struct Seen {
        glm::ivec2 size{1};
        std::optional<glm::vec2> pointer;
        std::optional<Hovered> hovered;
    };
    void take(const OpenModels& models);
    void take(const Baked& baked);
    void take(const Compressed& compressed);
    void take(const Occlusion& occlusion);
    void take(const EnvironmentFile& file);
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
    /// Of the document's model; null: it is of none.
    GpuModel* gpu_model(const Model* model) const;
    GpuModel& gpu_model(const SidePicture& picture) const;
    void recompress_where_asked();
    void follow_lamps();
    RadianceVersion version() const {
        return {document_.transfer_version, lighting_.rig.version(), lighting_.lamps_version(),
                settings.lit.suns_apart};
    }
    /// What a budget depends on.
    RadianceVersion lampless() const {
        RadianceVersion lampless = version();
        lampless.lamps = 0;
        return lampless;
    }
    const LightApart& light() {
        return lighting_.light_for_pictures(document_.light_order(), settings.lit.suns_apart);
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
