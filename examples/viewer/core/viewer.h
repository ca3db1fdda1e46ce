#pragma once

// The viewer without a window: panels, keys and scripts change its public members and call it, whoever owns
// the OpenGL context draws it.

#include "core/background_work.h"
#include "core/exposure.h"
#include "core/hovered.h"
#include "core/light_rig.h"
#include "core/model.h"
#include "core/orbit_camera.h"
#include "core/reference.h"
#include "core/settings.h"
#include "core/transfer_work.h"
#include "gpu/frame_renderer.h"
#include "gpu/gpu_model.h"
#include "gpu/gpu_timer.h"
#include "gpu/mesh_renderer.h"
#include "gpu/screen.h"

#include "prt/support/stopwatch.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace viewer {

/// What the panel and scripts report.
struct Figures {
    double frame_milliseconds = 0;     ///< mean of the last frames, from one to the next
    double longest_milliseconds = 0;   ///< between two frames, since `forget_longest`
    double gpu_milliseconds = 0;       ///< of a frame
    double vertex_milliseconds = 0;    ///< of the vertex stage of the right picture alone
    double constants_milliseconds = 0; ///< forming and uploading, when the light changes
    double open_milliseconds = 0;      ///< from asking for the model to its first frame
    std::size_t receivers = 0, triangles = 0, triangles_drawn = 0;
    std::size_t raw_bytes = 0;                         ///< of transfer as baked
    double bytes_per_vertex = 0, bytes_with_bases = 0; ///< compressed
    int clusters = 0, order = 0, channels = 0;
    int reference_passes = 0;
    Difference difference; ///< of the two pictures, while it is shown
};

class Viewer {
public:
    /// An OpenGL 4.5 context must be current, here and in all that draws.
    Viewer();

    /// Models and environment maps; a message for what is neither. At once: files are read in the background.
    /// A bake and what was compressed of it are shown together, be it that one of them is open already.
    void open(const std::vector<std::filesystem::path>& paths);
    /// Bakes the model anew, though it may hold transfer.
    void bake_anew();
    /// There is compressed transfer to save.
    bool can_save() const { return compressed_ != nullptr && !save_work_.busy(); }
    /// Writes the model with it in the background; a message says where, or why not. `output` empty: beside
    /// the model, under a name that is free.
    void save(std::filesystem::path output = {});
    /// The whole model in view, as it was when it was opened.
    void reset_camera();

    Settings settings;
    CompressionSettings compression; ///< what differs from what is there is compressed in the background
    OrbitCamera camera;
    LightSettings lights; ///< taken over by `update`
    bool day_runs = false;

    /// Takes in what was found in the background, and lets `seconds` pass.
    void update(double seconds);
    /// The frame, without panels. Throws `prt::Error` where the device cannot.
    void draw(std::uint32_t framebuffer, int width, int height);
    /// The pointer is over this pixel, or nowhere.
    void hover(std::optional<glm::vec2> pixel) { pointer_ = pixel; }

    const Figures& figures() const { return figures_; }
    void forget_longest() { figures_.longest_milliseconds = 0; }
    const std::optional<Hovered>& hovered() const { return hovered_; }
    /// Files are read, or the model is baked or compressed.
    bool busy() const { return work_.busy() || environment_work_.busy() || save_work_.busy(); }
    bool finding_numbers() const { return numbers_work_.busy(); }
    std::string stage() const { return work_.stage(); }
    double share() const { return work_.share(); }
    /// Newest last; shown until they are dismissed.
    std::deque<std::string>& messages() { return messages_; }
    void message(const std::string& text);
    /// What a side shows: what was asked for, or what stands in for it until it is there, and why.
    struct Shown {
        PictureKind kind;
        std::string note;
    };
    Shown shown(PictureKind wanted) const;

    bool has_model() const { return model_ != nullptr; }
    std::string model_name() const { return model_ ? model_->path.filename().string() : std::string(); }
    const Model* model() const { return model_.get(); }
    bool has_raw() const { return raw_ != nullptr; }
    int raw_order() const { return raw_ ? raw_->order : 0; }
    Screen screen() const;
    const std::vector<std::shared_ptr<const LoadedEnvironment>>& environments() const {
        return environments_;
    }
    void use_environment(std::size_t index);
    /// Of the environment that is used, or was last; empty: none yet.
    std::string environment_name() const { return rig_.environment_name(); }
    /// Stops of the automatic exposure of the last frame.
    float automatic_stops() const { return automatic_stops_; }
    /// The largest number of components of a cluster.
    int most_components() const { return compressed_ ? compressed_->bases.max_components() : 0; }
    FrameRenderer& renderer() { return gpu_->renderer; }

    /// The context is gone, with all that was on the GPU; call `restore_gpu` with another one.
    void release_gpu();
    void restore_gpu();

private:
    struct Gpu {
        FrameRenderer renderer;
        std::unique_ptr<GpuModel> model;
        prt::GlObject background;
        std::uint64_t background_version = 0, light_version = 0;
        GpuTimer frame, vertices;
        MeshRenderer meshes;
    };
    void open_models(const std::vector<std::filesystem::path>& paths);
    void open_environments(const std::vector<std::filesystem::path>& paths);
    void take(const LoadedModel& loaded);
    void set_baked(const Baked& baked);
    void set_compressed(std::shared_ptr<const prt::ClusteredTransfer> transfer,
                        const CompressionSettings& how);
    void set_occlusion(std::shared_ptr<const std::vector<float>> occlusion);
    void upload_model();
    void complete(BackgroundWork::Channel& channel, LoadedModel loaded);
    void find_occlusion(BackgroundWork::Channel& channel, const Model& model);
    void recompress_where_asked();
    void follow_light();
    void find_numbers();
    void show_reference(int side, int width, int height, const FrameView& view);
    void pick();
    void draw_lobe(std::uint32_t framebuffer, int width, int height, const FrameView& view);
    FrameView frame_view();
    int light_order() const;
    const prt::Light& light();
    bool wants(PictureKind kind) const;

    std::unique_ptr<Gpu> gpu_;
    LightRig rig_;
    prt::Light light_; ///< of `rig_` at `light_version_`
    std::uint64_t light_version_ = 0;
    std::vector<std::shared_ptr<const LoadedEnvironment>> environments_;
    std::vector<std::filesystem::path> environments_to_read_;
    std::shared_ptr<const Model> model_;
    std::shared_ptr<const prt::Transfer> raw_;
    std::shared_ptr<const prt::ClusteredTransfer> compressed_;
    std::shared_ptr<const std::vector<float>> occlusion_;
    CompressionSettings compressed_how_;
    prt::BakeRecord record_; ///< of the transfer
    BackgroundWork work_, environment_work_, numbers_work_, save_work_;
    std::uint64_t numbers_version_ = 0, transfer_version_ = 1;
    Reference reference_;
    std::string reference_subject_;
    std::uint64_t reference_version_ = 0;
    std::optional<Reference::Result> reference_result_;
    std::optional<glm::vec2> pointer_;
    std::optional<Hovered> hovered_;
    Figures figures_;
    std::deque<std::string> messages_;
    std::optional<prt::Stopwatch> opening_;
    prt::Stopwatch since_frame_;
    int width_ = 1, height_ = 1;
    std::uint64_t frames_ = 0;
    double mean_radiance_ = 1;
    ExposureMeter exposure_meter_;
    float automatic_stops_ = 0;
};

} // namespace viewer
