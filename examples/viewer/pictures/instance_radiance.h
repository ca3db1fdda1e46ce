#pragma once

// Exit radiance of all vertices of instances that share transfer, eight bytes each. It is found once for a
// lighting, not in every frame: then a frame reads one vector for a vertex, whatever the transfer has.

#include "prt/gl_scene.h"
#include "prt/gl_transfer.h"
#include "prt/instance_former.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace viewer {

/// Instances that follow each other in the table of an InstanceFormer, all of one mesh, and its vertex
/// arrays.
struct MeshInstances {
    std::size_t first = 0, count = 0;
    std::vector<std::size_t> vertex_arrays;
};

class InstanceRadiance {
public:
    /// `formed`: all instances, of which `meshes` are parts; vertex arrays are those of `scene`, which lasts.
    InstanceRadiance(const prt::ClusteredTransfer& transfer, const prt::GlScene& scene,
                     std::span<const prt::FormedInstance> formed, std::span<const MeshInstances> meshes);

    void set_light(const prt::Lighting& lighting);
    /// For `program`, which is in use: where shaders/instance_radiance.glsl finds the vertices of mesh `mesh`
    /// in vertex array `vertex_array`, one of it.
    void use(const prt::GlObject& program, std::size_t mesh, std::size_t vertex_array) const;

    std::size_t bytes() const;                                   ///< of exit radiance
    std::size_t bytes_of_constants() const;                      ///< of which it is found
    double seconds_formed() const { return constants_.seconds; } ///< of these, when the light last changed

private:
    /// A vertex array of a mesh.
    struct Place {
        std::size_t mesh, vertex_array, vertices;
        std::size_t first_instance, instances;
        std::size_t begin; ///< bytes
        std::size_t bytes() const;
    };
    void attach_table(const prt::GlVertexArrays& arrays) const;
    void bind(const prt::GlObject& program, const Place& place) const;

    prt::GlTransfer transfer_; ///< weights and clusters
    prt::InstanceFormer former_;
    prt::GlVertexArrays arrays_;
    prt::GlObject table_, program_, framebuffer_, radiance_;
    std::vector<Place> places_;
    struct Constants {
        std::vector<glm::vec4> formed;
        prt::GlObject buffer;
        double seconds = 0;
    };
    Constants constants_;
};

} // namespace viewer
