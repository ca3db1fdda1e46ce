#pragma once

// A scene of instances on the GPU: meshes once, drawn as often as they stand in view, and lit by transfer
// that they share.

#include "pictures/instance_radiance.h"

#include "prt/instances_gltf.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace viewer {

/// What one of them takes.
struct InstanceFigures {
    std::size_t instances = 0, meshes = 0;
    std::size_t bytes_in_file = 0;  ///< factors
    double bytes_of_constants = 0;  ///< on average, of a lighting
    double bytes_of_radiance = 0;   ///< the same, of vertices, which is found of these
    double milliseconds_formed = 0; ///< of all, when the light last changed
};

class GpuInstances {
public:
    /// `model` has compressed transfer; `origin` is that of the scene that is shown.
    GpuInstances(std::shared_ptr<const prt::InstancedModel> model, std::span<const prt::Texture> textures,
                 const glm::dvec3& origin);

    const prt::TransferLayout& layout() const { return model_->compressed->transfer.bases.layout; }
    void set_light(const prt::Lighting& lighting) { radiance_->set_light(lighting); }
    InstanceFigures figures() const;

    /// Chooses what may be visible; near ones come first, or where `culling` is off all.
    void look(const glm::mat4& view_projection, const glm::vec3& eye, bool culling);
    void shine(std::span<const glm::vec3> strengths) { scene_.shine(strengths); }
    /// Draws what was chosen with `program`, in use, of the blended surfaces or of all others. `lit`: by the
    /// transfer, with a program of shaders/instance_radiance.glsl. Returns how many triangles.
    std::size_t draw(const prt::GlObject& program, bool lit, bool blended) const;

private:
    /// Attributes of an instance, as a vertex shader takes them.
    struct Row {
        std::array<glm::vec4, 3> world; ///< rows of the matrix
        std::uint32_t number;           ///< in its group
    };
    /// A mesh, or a node of the scene that nothing shares.
    struct Group {
        int node = 0;
        std::vector<std::size_t> primitives;
        std::vector<Row> rows;
        std::vector<glm::vec4> spheres;   ///< [instances] round it: middle and radius
        std::size_t first = 0, count = 0; ///< of those that were chosen
    };
    std::vector<prt::FormedInstance> add_groups(const glm::dvec3& origin);
    void attach(const prt::GlVertexArrays& arrays) const;

    std::shared_ptr<const prt::InstancedModel> model_;
    prt::GlScene scene_;
    std::vector<Group> groups_;
    prt::GlVertexArrays arrays_;
    prt::GlObject rows_;
    std::optional<InstanceRadiance> radiance_;
    std::size_t instances_ = 0;
};

} // namespace viewer
