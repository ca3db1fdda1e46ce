#pragma once

// Depth maps of a scene as seen from far away.

#include "prt/gl_objects.h"
#include "prt/scene.h"
#include "trace/gpu/gpu_structs.h"
#include "trace/gpu/raster_scene.h"

#include <array>
#include <functional>
#include <optional>
#include <span>

namespace prt {

class DepthMaps {
public:
    /// Maps of `resolution` squared texels; keeps a reference to `scene`. `blends`: some surfaces stop light
    /// in part, and their layers can be peeled. Throws `Error` where the device has no such maps.
    DepthMaps(const RasterScene& scene, const Bounds& bounds, int resolution, bool blends);

    /// Directions that there are maps for; layers belong to one at a time.
    std::size_t at_once() const { return layers_ ? 1 : kMost; }
    int resolution() const { return resolution_; }
    bool blends() const { return layers_.has_value(); }
    /// The directions as the shaders read them.
    GlObject table(std::span<const glm::vec3> directions, int order) const;
    /// Draws what stops light altogether.
    void draw(std::span<const glm::vec3> directions) const;
    /// Draws blended layers from the light inwards, until one is empty, and calls `look_up` after each, when
    /// shaders find it in their texture units.
    void peel(const glm::vec3& direction, const std::function<void()>& look_up) const;
    /// Puts the maps where shaders find them.
    void bind() const;

private:
    static constexpr std::size_t kMost = 8;
    struct Layers {
        std::array<GlObject, 2> depth; ///< this layer's and the last one's, in turns
        GlObject coverage, target, program;
    };
    void make_layers();
    glm::mat4 map_matrix(const glm::vec3& direction) const;
    void draw(const GlObject& program, const GlObject& target, const glm::vec3& direction) const;

    const RasterScene& scene_;
    int resolution_;
    glm::vec3 center_; ///< of the sphere round the scene
    float radius_;
    GlObject maps_, target_, program_, no_vertices_;
    std::optional<Layers> layers_;
};

} // namespace prt
