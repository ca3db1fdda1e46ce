#pragma once

#include "pictures/figure_pose.h"

#include "prt/core/lobes.h"
#include "prt/gltf/animation.h"
#include "runtime/render/gl/gl_scene.h"

#include <span>
#include <vector>

namespace viewer {

/// A scene on the GPU whose vertices are moved by the vertex shader (shaders/skinning.glsl). Its address must
/// not change.
class GpuMoving {
public:
    /// `scene` contains the vertices before they are moved.
    GpuMoving(prt::Scene scene, std::span<const prt::MovingVertices> moving,
              std::span<const prt::Texture> textures);
    GpuMoving(const GpuMoving&) = delete;
    GpuMoving& operator=(const GpuMoving&) = delete;

    /// Sets the lobes that light its vertices in PRT_LOBED programs.
    void set_lobes(const prt::LobeModel& lobes);
    void move(const Palettes& palettes);
    /// Draws everything with a program of viewer_moving.vert, which must be in use.
    void draw(const prt::GlObject& program);
    /// Draws everything with a PRT_SKINNED program of sun_caster.vert, which must be in use.
    void draw_casters(const prt::GlObject& program);

private:
    struct Vertices {
        prt::GlObject influences, palette;
        int each = 0; ///< influences per vertex; 0: all vertices use one matrix
        std::size_t matrices = 0;
    };
    /// Returns whether a primitive belongs to the figure: with lobes, only those that have lobes.
    bool moves(std::size_t primitive) const;
    void bind(const prt::GlObject& program, std::size_t primitive) const;

    prt::Scene scene_;
    prt::GlScene gpu_;
    prt::GlVertexArrays arrays_;
    std::vector<Vertices> vertices_; ///< [vertex arrays]
    prt::GlObject lobe_words_, lobe_profiles_;
};

/// Returns a figure's scene with its vertices before they are moved.
prt::Scene scene_before_moving(const prt::AnimatedScene& figure);

/// A sphere of radius 1 about the origin with this base color, moved by one matrix.
struct UnitSphere {
    prt::Scene scene;
    std::vector<prt::MovingVertices> moving;
};
UnitSphere unit_sphere(const glm::vec3& color);

/// Base color of white paper.
inline constexpr glm::vec3 kMattColor(0.8f);

} // namespace viewer
