// Lights and draws the moving objects.

#include "pictures/moving_stage.h"

#include "prt/render/texture.h"
#include "prt/shader/shader_source.h"
#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace viewer {
namespace {

/// The second sphere is polished metal.
constexpr std::array kSphereColors = {kMattColor, glm::vec3(0.9f)};
/// Number of sky bands that light lobes without a volume; the light has at least this order.
constexpr int kOrderOfSky = 3;
/// Radius of a probe's sphere, in finest cells.
constexpr float kProbeRadius = 0.1f;

bool sees_nothing(const prt::ProbeVisibility& visibility) {
    return std::ranges::all_of(visibility, [](std::uint8_t distance) { return distance == 0; });
}

std::vector<glm::vec4> positions_of_probes(const prt::CompressedVolume& volume) {
    const prt::VolumeProbes probes = prt::probes_of(volume.grid);
    std::vector<glm::vec4> positions;
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const float radius = kProbeRadius * volume.grid.spacing * static_cast<float>(1 << probes.levels[p]);
        positions.emplace_back(prt::position_of(volume.grid, probes.corners[p]),
                               sees_nothing(volume.visibility[p]) ? -radius : radius);
    }
    return positions;
}

} // namespace

MovingStage::MovingStage()
    : programs_{{}, prt::make_program("sun_caster.vert", "sun_caster.frag", "#define PRT_SKINNED\n"), {}},
      no_vertices_(prt::make_vertex_array()) {}

void MovingStage::set_figure(std::shared_ptr<const prt::AnimatedScene> figure, const prt::LobeModel* lobes) {
    figure_.reset();
    lobes_.reset();
    std::erase_if(programs_.surfaces, [](const auto& program) { return program.first.lobed; });
    shadows_.set_figure({});
    pose_ = {};
    ++moved_;
    if (figure)
        figure_ = std::make_unique<GpuMoving>(scene_before_moving(*figure), figure->vertices(),
                                              prt::load_textures(figure->scene(), prt::BadTextures::ignore));
    if (figure && lobes) {
        lobes_ = *lobes;
        figure_->set_lobes(*lobes_);
    }
}

void MovingStage::set_volume(std::shared_ptr<const prt::CompressedVolume> volume) {
    volume_ = {};
    programs_.surfaces.clear();
    programs_.probes = {};
    if (!volume)
        return;
    volume_.transfer = std::move(volume);
    volume_.gpu = std::make_unique<prt::GlRelitTextures>(*volume_.transfer);
    volume_.defines = "#define PRT_VOLUME\n" + prt::volume_defines(*volume_.transfer);
    const std::vector<glm::vec4> positions = positions_of_probes(*volume_.transfer);
    volume_.probe_positions = prt::make_buffer(std::span<const glm::vec4>(positions));
    volume_.probes = static_cast<int>(positions.size());
    light_volume();
}

void MovingStage::pose(const FigurePose& pose) {
    if (!figure_ || pose.version == pose_.version)
        return;
    figure_->move(pose.palettes);
    pose_ = pose;
    ++moved_;
}

void MovingStage::place(const TwoSpheres& spheres) {
    if (spheres == spheres_)
        return;
    spheres_ = spheres;
    ++moved_;
    for (std::size_t i = 0; i < 2; ++i) {
        if (!sphere_models_[i]) {
            UnitSphere sphere = unit_sphere(kSphereColors[i]);
            sphere_models_[i] = std::make_unique<GpuMoving>(std::move(sphere.scene), sphere.moving,
                                                            std::span<const prt::Texture>());
        }
        const glm::mat4 at = glm::translate(glm::mat4(1), spheres_.middles[i]);
        sphere_models_[i]->move({{glm::scale(at, glm::vec3(spheres_.radius))}});
    }
}

void MovingStage::set_lighting(const prt::Lighting& lighting, std::span<const prt::Sun> suns,
                               const LampSettings& lamps) {
    lit_ = {lighting, !suns.empty(), lamps};
    light_volume();
}

void MovingStage::light_volume() {
    if (!volume_.gpu || !lit_.lighting)
        return;
    const prt::TransferLayout& layout = volume_.gpu->relighter().layout();
    if (lit_.lighting->sky.order >= layout.order)
        volume_.gpu->set_light(with_lamps(*lit_.lighting, lit_.lamps, layout));
}

/// Returns true if suns are added per pixel. A volume without a separate direct term has them in its sky.
bool MovingStage::adds_suns() const {
    return lit_.suns && (!has_volume() || volume_.gpu->relighter().layout().has(prt::TermKind::direct));
}

std::optional<prt::Bounds> MovingStage::box() const {
    std::optional<prt::Bounds> all;
    const auto add = [&](const prt::Bounds& box) {
        all = all ? prt::Bounds{glm::min(all->low, box.low), glm::max(all->high, box.high)} : box;
    };
    if (shows_figure())
        add(pose_.box);
    for (const glm::vec3& middle : spheres_.middles)
        if (shows_spheres())
            add({middle - spheres_.radius, middle + spheres_.radius});
    return all;
}

std::optional<OccluderPass> MovingStage::occluders() {
    if (!shown_.contact || (!shows_figure() && !shows_spheres()))
        return std::nullopt;
    std::vector<Ball> balls;
    for (const glm::vec3& middle : spheres_.middles)
        if (shows_spheres())
            balls.push_back({middle, spheres_.radius});
    shadows_.place(shows_figure() ? &pose_ : nullptr, balls);
    if (shadows_.empty())
        return std::nullopt;
    if (volume_.gpu)
        volume_.gpu->bind_volume();
    return OccluderPass{&shadows_, volume_.defines};
}

prt::SunShadows::Moving MovingStage::casters() {
    if (!shows_figure() && !shows_spheres())
        return {};
    const std::uint64_t shown = (shows_figure() ? 1u : 0u) + (shows_spheres() ? 2u : 0u);
    return {.draw =
                [this](int map, int size) {
                    glUseProgram(programs_.caster.name());
                    prt::SunShadows::set_map(programs_.caster, map, size);
                    if (shows_figure())
                        figure_->draw_casters(programs_.caster);
                    for (const auto& sphere : sphere_models_)
                        if (shows_spheres())
                            sphere->draw_casters(programs_.caster);
                },
            .box = *box(),
            .version = 4 * moved_ + shown};
}

const prt::GlObject& MovingStage::program(const Surface& surface) {
    prt::GlObject& program = programs_.surfaces[surface];
    if (program.name() == 0) {
        std::string defines = volume_.defines + (surface.suns ? "#define PRT_SUNS\n" : "");
        if (surface.lobed)
            defines += "#define PRT_LOBED\n" +
                       prt::lobe_defines(*lobes_, has_volume() ? volume_.transfer->order : kOrderOfSky);
        program = prt::make_program("viewer_moving.vert", "viewer_moving.frag", defines);
    }
    return program;
}

const prt::GlObject& MovingStage::use(const Surface& surface, const MovingPass& pass) {
    const prt::GlObject& moving = program(surface);
    glUseProgram(moving.name());
    if (volume_.gpu)
        volume_.gpu->bind_volume();
    glUniformMatrix4fv(prt::uniform(moving, "view_projection"), 1, GL_FALSE,
                       glm::value_ptr(pass.view_projection));
    glUniform3fv(prt::uniform(moving, "eye"), 1, glm::value_ptr(pass.eye));
    glUniform3fv(prt::uniform(moving, "irradiance_sh"), 9, glm::value_ptr(pass.irradiance.front()));
    glUniform3fv(prt::uniform(moving, "sky_sh"), kOrderOfSky * kOrderOfSky,
                 glm::value_ptr(lit_.lighting->sky.coefficients.front()));
    glUniform1i(prt::uniform(moving, "textured"), pass.textured);
    glUniform1i(prt::uniform(moving, "chrome"), 0);
    return moving;
}

void MovingStage::draw(const MovingPass& pass) {
    if (!lit_.lighting)
        return;
    if (shows_figure())
        figure_->draw(use({adds_suns(), lobes_.has_value()}, pass));
    const prt::GlObject& moving = use({adds_suns(), false}, pass);
    for (std::size_t i = 0; i < 2; ++i) {
        if (!shows_spheres())
            continue;
        glUniform1i(prt::uniform(moving, "chrome"), static_cast<int>(i));
        sphere_models_[i]->draw(moving);
    }
    if (shows_probes())
        draw_probes(pass);
    prt::check_gl("drawing moving objects");
}

void MovingStage::draw_probes(const MovingPass& pass) {
    if (programs_.probes.name() == 0)
        programs_.probes = prt::make_program("viewer_probes.vert", "viewer_probes.frag", volume_.defines);
    glUseProgram(programs_.probes.name());
    glUniformMatrix4fv(prt::uniform(programs_.probes, "view_projection"), 1, GL_FALSE,
                       glm::value_ptr(pass.view_projection));
    prt::set_uniform(programs_.probes, "exposure", pass.exposure);
    prt::bind_storage(PRT_BINDING_PROBE_POSITIONS, volume_.probe_positions);
    glBindVertexArray(no_vertices_.name());
    glEnable(GL_CULL_FACE);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 6 * PRT_PROBE_COLUMNS * PRT_PROBE_ROWS, volume_.probes);
}

} // namespace viewer
