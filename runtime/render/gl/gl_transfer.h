#pragma once

// Compressed transfer of vertices on the GPU. An OpenGL 4.5 context must be current for all functions.

#include "prt/core/cluster_lighting.h"
#include "prt/core/glm_layout.h"
#include "runtime/render/gl/gl_objects.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Compressed transfer of vertices on the GPU. A vertex shader that includes `shaders/prt_exit_radiance.glsl`
/// computes exit radiance from it.
class GlTransfer {
public:
    /// Uploads clusters and weights; keeps no reference to `transfer`. Call `set_light` before drawing.
    /// Throws `Error` if the layout of the transfer is invalid, if the weights of a receiver need more vertex
    /// attributes than shaders have, or if GPU memory runs out.
    explicit GlTransfer(const ClusteredTransfer& transfer);

    /// Returns the #define lines for shaders that include prt_exit_radiance.glsl. These shaders must pass
    /// positions in metres relative to Scene::origin.
    const std::string& defines() const { return defines_; }
    /// Computes the constants of all clusters for `lighting` on the CPU, and uploads them. Throws the errors
    /// of `ClusterLighting::update`.
    void set_light(const Lighting& lighting);
    /// Makes the weights (and the cluster indices, unless they are part of packed weights) attributes of the
    /// vertex array object `vertex_array` (a name of OpenGL). Vertex v of the array gets those of receiver
    /// first + v. `first`: VertexArray::first_receiver. Uses the vertex buffer bindings 8 and 9 of the array.
    /// This object must exist while `vertex_array` is drawn.
    void attach(std::uint32_t vertex_array, std::size_t first) const;
    /// Binds the constants, and the table with the layout of each cluster, as storage buffers for subsequent
    /// draws.
    void use() const;
    /// Returns the size of the data that shaders read in bytes: weights, cluster indices (unless they are
    /// part of packed weights), layouts of the clusters and constants.
    std::size_t bytes() const { return bytes_; }

private:
    int weight_vectors_ = 0, words_ = 0;
    std::string defines_;
    ClusterLighting relighter_;
    std::vector<glm::vec4> computed_;
    GlObject clusters_, weights_, layouts_, constants_;
    std::size_t bytes_ = 0;
};

} // namespace prt
