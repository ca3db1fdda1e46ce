#pragma once

// Compressed transfer on the GPU.

#include "prt/cluster_lighting.h"
#include "prt/gl_objects.h"
#include "prt/support/glm_layout.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace prt {

/// Compressed transfer on the GPU, for `shaders/prt_exit_radiance.glsl`.
class GlTransfer {
public:
    /// Uploads clusters and weights. Throws `Error` if they do not fit the vertex attributes.
    explicit GlTransfer(const ClusteredTransfer& transfer);

    /// Define lines for shaders that include prt_exit_radiance.glsl. Such shaders pass positions as in the
    /// Scene.
    const std::string& defines() const { return defines_; }
    /// Computes the constants for `lighting` and uploads them.
    void set_light(const Lighting& lighting);
    /// Binds the weights and clusters of the receivers from `first` on as attributes of `vertex_array`.
    void attach(std::uint32_t vertex_array, std::size_t first) const;
    /// Binds the constants and the table of clusters for subsequent draws.
    void use() const;
    /// Size of the data that shaders read, bytes.
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
