#pragma once

// An instanced scene on the GPU: each mesh is stored once, drawn for every visible instance, and lit by
// shared transfer.

#include "pictures/instance_radiance.h"

#include "prt/gltf/transfer_gltf.h"

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

/// Size and cost of an instanced scene.
struct InstanceFigures {
    std::size_t instances = 0, meshes = 0;
    std::size_t bytes_in_file = 0;     ///< factors of an instance in the file
    double bytes_of_constants = 0;     ///< constants of an instance for a lighting, on average
    double bytes_of_radiance = 0;      ///< exit radiance of the vertices of an instance, on average
    double milliseconds_to_update = 0; ///< time to compute all constants at the last change of light
};

class GpuInstances {
public:
    /// `model` must have compressed transfer; `origin` is that of the shown scene.
    GpuInstances(std::shared_ptr<const prt::InstancedModel> model, std::span<const prt::Texture> textures,
                 const glm::dvec3& origin);

    const prt::TransferLayout& layout() const { return model_->compressed->transfer.bases.layout; }
    void set_light(const prt::Lighting& lighting) { radiance_->set_light(lighting); }
    InstanceFigures figures() const;

    /// Selects the instances that may be visible, near ones first; all instances if `culling` is off.
    void look(const glm::mat4& view_projection, const glm::vec3& eye, bool culling);
    void shine(std::span<const glm::vec3> strengths) { scene_.shine(strengths); }
    /// Draws the selected instances with `program`, which must be in use: their blended surfaces or all
    /// others. If `lit`, `program` uses the transfer (shaders/instance_radiance.glsl). Returns the number of
    /// triangles.
    std::size_t draw(const prt::GlObject& program, bool lit, bool blended) const;

private:
    /// Attributes of an instance in the vertex shader.
    struct Row {
        std::array<glm::vec4, 3> world; ///< rows of the matrix
        std::uint32_t number;           ///< index in its group
    };
    /// A mesh with all its instances, or a node of the scene that is not shared.
    struct Group {
        int node = 0;
        std::vector<std::size_t> primitives;
        std::vector<Row> rows;
        std::vector<glm::vec4> spheres;   ///< [instances] bounding spheres: center and radius
        std::size_t first = 0, count = 0; ///< range of the selected instances
    };
    std::vector<prt::RelitInstance> add_groups(const glm::dvec3& origin);
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
