#pragma once

#include "pictures/figure_pose.h"

#include "prt/animation.h"
#include "prt/gl_scene.h"
#include "prt/lobes.h"

#include <span>
#include <vector>

namespace viewer {

/// A scene on the GPU whose vertices the vertex shader moves (shaders/skinning.glsl). Stays where it is.
class GpuMoving {
public:
    /// `scene` with its vertices as they are before they move.
    GpuMoving(prt::Scene scene, std::span<const prt::MovingVertices> moving,
              std::span<const prt::Texture> textures);
    GpuMoving(const GpuMoving&) = delete;
    GpuMoving& operator=(const GpuMoving&) = delete;

    /// From now on they light its vertices where the program is PRT_LOBED.
    void set_lobes(const prt::LobeModel& lobes);
    void move(const Palettes& palettes);
    /// Draws all of it with a program of viewer_moving.vert, in use.
    void draw(const prt::GlObject& program);
    /// The same with one of sun_caster.vert, PRT_SKINNED.
    void draw_casters(const prt::GlObject& program);

private:
    struct Vertices {
        prt::GlObject influences, palette;
        int each = 0; ///< influences of a vertex; 0: all go by one matrix
        std::size_t matrices = 0;
    };
    void bind(const prt::GlObject& program, std::size_t primitive) const;

    prt::Scene scene_;
    prt::GlScene gpu_;
    prt::GlVertexArrays arrays_;
    std::vector<Vertices> vertices_; ///< [vertex arrays]
    prt::GlObject lobe_words_, lobe_profiles_;
};

/// A figure's scene with its vertices as they are before they move.
prt::Scene scene_before_moving(const prt::AnimatedScene& figure);

/// A sphere of radius 1 about the origin, of that base color, and how it moves: by one matrix.
struct UnitSphere {
    prt::Scene scene;
    std::vector<prt::MovingVertices> moving;
};
UnitSphere unit_sphere(const glm::vec3& color);

/// White paper.
inline constexpr glm::vec3 kMattColor(0.8f);

} // namespace viewer
