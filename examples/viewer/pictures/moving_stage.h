#pragma once

// The moving objects on the GPU, lit by the volume of the open scene: a figure, two spheres, and the probes.

#include "pictures/contact_shadows.h"
#include "pictures/gpu_moving.h"
#include "pictures/lamps.h"
#include "pictures/settings.h"

#include "runtime/render/gl/gl_relit_textures.h"
#include "runtime/render/gl/sun_shadows.h"

#include <array>
#include <map>
#include <memory>
#include <optional>

namespace viewer {

/// Parameters of one drawing of the moving objects.
struct MovingPass {
    glm::mat4 view_projection{1};
    glm::vec3 eye{0};
    bool textured = true;
    float exposure = 1;
    const std::array<glm::vec3, 9>& irradiance; ///< irradiance of the sky, used until there is a volume
};

/// A matte and a mirroring sphere.
struct TwoSpheres {
    std::array<glm::vec3, 2> middles{}; ///< centers, the matte one first
    float radius = 0;                   ///< metres; 0: none

    friend bool operator==(const TwoSpheres&, const TwoSpheres&) = default;
};

class MovingStage {
public:
    MovingStage();

    /// `figure` null: there is none; `lobes` null: its vertices have no lobes.
    void set_figure(std::shared_ptr<const prt::AnimatedScene> figure, const prt::LobeModel* lobes);
    void set_occluders(std::vector<prt::NodeOccluder> occluders) {
        shadows_.set_figure(std::move(occluders));
    }
    void set_volume(std::shared_ptr<const prt::CompressedVolume> volume);
    void pose(const FigurePose& pose);
    void place(const TwoSpheres& spheres);
    void show(const MovingSettings& settings) { shown_ = settings; }
    /// `suns` are not part of `lighting`: they are added per pixel if the volume has a separate direct term.
    void set_lighting(const prt::Lighting& lighting, std::span<const prt::Sun> suns,
                      const LampSettings& lamps);

    bool has_volume() const { return volume_.gpu != nullptr; }
    bool shows_anything() const { return shows_figure() || shows_spheres() || shows_probes(); }
    /// Returns the box around the shown objects except probes.
    std::optional<prt::Bounds> box() const;
    /// Returns the occluders that shade nearby surfaces; empty if no shown object has any. Binds the volume.
    std::optional<OccluderPass> occluders();
    /// Returns the objects that cast shadows into shadow maps.
    prt::SunShadows::Moving casters();
    /// Draws over the scene; the maps of its suns must be bound.
    void draw(const MovingPass& pass);

private:
    struct Volume {
        std::shared_ptr<const prt::CompressedVolume> transfer;
        std::unique_ptr<prt::GlRelitTextures> gpu;
        std::string defines;
        prt::GlObject probe_positions;
        int probes = 0;
    };
    struct Lit {
        std::optional<prt::Lighting> lighting;
        bool suns = false;
        LampSettings lamps;
    };
    bool shows_figure() const { return figure_ && shown_.figure && pose_.version > 0; }
    bool shows_spheres() const { return shown_.spheres && spheres_.radius > 0; }
    bool shows_probes() const { return shown_.probes && has_volume(); }
    void light_volume();
    bool adds_suns() const;
    struct Surface { ///< key of a program that draws surfaces
        bool suns, lobed;

        friend auto operator<=>(const Surface&, const Surface&) = default;
    };
    const prt::GlObject& program(const Surface& surface);
    const prt::GlObject& use(const Surface& surface, const MovingPass& pass);
    void draw_probes(const MovingPass& pass);

    std::unique_ptr<GpuMoving> figure_;
    std::optional<prt::LobeModel> lobes_;                     ///< lobes of the figure
    std::array<std::unique_ptr<GpuMoving>, 2> sphere_models_; ///< created when they are first shown
    MovingSettings shown_;
    FigurePose pose_;
    TwoSpheres spheres_;
    ContactShadows shadows_;
    std::uint64_t moved_ = 1;
    Volume volume_;
    Lit lit_;
    struct Programs {
        std::map<Surface, prt::GlObject> surfaces;
        prt::GlObject caster, probes;
    };
    Programs programs_;
    prt::GlObject no_vertices_;
};

} // namespace viewer
