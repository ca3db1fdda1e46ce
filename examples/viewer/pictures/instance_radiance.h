#pragma once

// Exit radiance of all vertices of instances that share transfer, eight bytes each. It is computed once per
// lighting, not in every frame: a frame then reads one vector per vertex, independent of the transfer.

#include "prt/core/instances.h"
#include "runtime/render/gl/gl_scene.h"
#include "runtime/render/gl/gl_transfer.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace viewer {

/// Consecutive instances of one mesh in the table of an InstanceRelighter, and the vertex arrays of the mesh.
struct MeshInstances {
    std::size_t first = 0, count = 0;
    std::vector<std::size_t> vertex_arrays;
};

class InstanceRadiance {
public:
    /// `computed` are all instances, and `meshes` are ranges of them. Vertex arrays are those of `scene`,
    /// which must outlive this object.
    InstanceRadiance(const prt::ClusteredTransfer& transfer, const prt::GlScene& scene,
                     std::span<const prt::RelitInstance> computed, std::span<const MeshInstances> meshes);

    void set_light(const prt::Lighting& lighting);
    /// Sets the location of the vertices of mesh `mesh` in its vertex array `vertex_array` for
    /// shaders/instance_radiance.glsl. `program` must be in use.
    void use(const prt::GlObject& program, std::size_t mesh, std::size_t vertex_array) const;

    std::size_t bytes() const;              ///< size of the exit radiance
    std::size_t bytes_of_constants() const; ///< size of the constants it is computed
                                            ///< from
    double seconds_to_update() const {
        return constants_.seconds;
    } ///< time to compute the constants at the
      ///< last change of light

private:
    /// A vertex array of a mesh, and its range of the radiance buffer.
    struct Draw {
        std::size_t mesh, vertex_array, vertices;
        std::size_t first_instance, instances;
        std::size_t begin; ///< offset, bytes
        std::size_t bytes() const;
    };
    void attach_table(const prt::GlVertexArrays& arrays) const;
    void bind(const prt::GlObject& program, const Draw& draw) const;

    prt::GlTransfer transfer_; ///< weights and clusters
    prt::InstanceRelighter relighter_;
    prt::GlVertexArrays arrays_;
    prt::GlObject table_, program_, framebuffer_, radiance_;
    std::vector<Draw> draws_;
    struct Constants {
        std::vector<glm::vec4> computed;
        prt::GlObject buffer;
        double seconds = 0;
    };
    Constants constants_;
};

} // namespace viewer
