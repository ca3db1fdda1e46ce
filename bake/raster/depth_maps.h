#pragma once

// Orthographic depth maps of a scene.

#include "bake/raster/raster_scene.h"
#include "prt/load/scene.h"
#include "runtime/render/gl/gl_objects.h"
#include "shared_structs.h"

#include <array>
#include <functional>
#include <optional>
#include <span>

namespace prt {

class DepthMaps {
public:
    /// Creates maps of `resolution` squared texels; keeps a reference to `scene`. `blends`: some surfaces
    /// stop light partially, and their layers can be peeled. Throws `Error` if the device does not support
    /// such maps.
    DepthMaps(const RasterScene& scene, const Bounds& bounds, int resolution, bool blends);

    /// Number of directions with maps at the same time; layers exist for one direction at a time.
    std::size_t at_once() const { return layers_ ? 1 : kMax; }
    int resolution() const { return resolution_; }
    bool blends() const { return layers_.has_value(); }
    /// Returns the directions in the layout of the shaders.
    GlObject table(std::span<const glm::vec3> directions, int order) const;
    /// Draws surfaces that stop all light.
    void draw(std::span<const glm::vec3> directions) const;
    /// Draws blended layers, starting at the light, until a layer is empty. Calls `look_up` after each layer,
    /// when it is bound to the texture units of the shaders.
    void peel(const glm::vec3& direction, const std::function<void()>& look_up) const;
    /// Binds the maps to the texture units of the shaders.
    void bind() const;

private:
    static constexpr std::size_t kMax = 8;
    struct Layers {
        std::array<GlObject, 2> depth; ///< depth of this layer and of the previous layer, alternating
        GlObject coverage, target, program;
    };
    void make_layers();
    glm::mat4 map_matrix(const glm::vec3& direction) const;
    void draw(const GlObject& program, const GlObject& target, const glm::vec3& direction) const;

    const RasterScene& scene_;
    int resolution_;
    glm::vec3 center_; ///< center of the bounding sphere of the scene
    float radius_;
    GlObject maps_, target_, program_, no_vertices_;
    std::optional<Layers> layers_;
};

} // namespace prt
