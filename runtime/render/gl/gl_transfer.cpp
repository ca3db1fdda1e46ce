// Uploads compressed transfer as vertex attributes and storage buffers.

#include "runtime/render/gl/gl_transfer.h"

#include "prt/shader/shader_source.h"
#include "shared_layout.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace prt {
namespace {

// The header of ClusterLayout is installed and includes no shader header; the table may also be a texture,
// which has no structs. The layout is therefore defined on both sides, and compared here.
static_assert(sizeof(ClusterLayout) == sizeof(glm::uvec4) &&
              offsetof(ClusterLayout, first_row) == PRT_CLUSTER_FIRST_ROW * sizeof(std::uint32_t) &&
              offsetof(ClusterLayout, components) == PRT_CLUSTER_COMPONENTS * sizeof(std::uint32_t) &&
              offsetof(ClusterLayout, widths) == PRT_CLUSTER_WIDTHS * sizeof(std::uint32_t));

} // namespace

GlTransfer::GlTransfer(const ClusteredTransfer& transfer)
    : weight_vectors_(transfer.receivers.components / 4), words_(transfer.receivers.words),
      defines_("#define PRT_COMPRESSED\n" + relight_defines(transfer)), relighter_(transfer) {
    clusters_ = make_buffer(std::span<const std::uint16_t>(transfer.receivers.clusters));
    weights_ = make_buffer(std::span<const std::byte>(transfer.receivers.weights));
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    layouts_ = make_buffer(std::span<const ClusterLayout>(layouts));
    computed_.resize(relighter_.rows());
    constants_ = make_buffer(std::span<const glm::vec4>(computed_));
    bytes_ = transfer.receivers.clusters.size() * sizeof(std::uint16_t) + transfer.receivers.weights.size() +
             layouts.size() * sizeof(ClusterLayout) + computed_.size() * sizeof(glm::vec4);
}

void GlTransfer::set_light(const Lighting& lighting) {
    relighter_.update(lighting, computed_);
    glNamedBufferSubData(constants_.name(), 0, static_cast<GLsizeiptr>(computed_.size() * sizeof(glm::vec4)),
                         computed_.data());
}

void GlTransfer::attach(std::uint32_t vertex_array, std::size_t first) const {
    constexpr GLuint kClusterBinding = 8, kWeightBinding = 9;
    if (words_ == 0) {
        glVertexArrayVertexBuffer(vertex_array, kClusterBinding, clusters_.name(),
                                  static_cast<GLintptr>(first * sizeof(std::uint16_t)),
                                  sizeof(std::uint16_t));
        glEnableVertexArrayAttrib(vertex_array, PRT_LOCATION_CLUSTER);
        glVertexArrayAttribIFormat(vertex_array, PRT_LOCATION_CLUSTER, 1, GL_UNSIGNED_SHORT, 0);
        glVertexArrayAttribBinding(vertex_array, PRT_LOCATION_CLUSTER, kClusterBinding);
    }
    const int attributes = words_ > 0 ? (words_ + 3) / 4 : weight_vectors_;
    if (attributes == 0)
        return;
    constexpr std::size_t kAttributeBytes = 16; // four words, or four floats
    const std::size_t stride = words_ > 0 ? 4 * static_cast<std::size_t>(words_)
                                          : kAttributeBytes * static_cast<std::size_t>(weight_vectors_);
    glVertexArrayVertexBuffer(vertex_array, kWeightBinding, weights_.name(),
                              static_cast<GLintptr>(first * stride), static_cast<GLsizei>(stride));
    for (int v = 0; v < attributes; ++v) {
        const auto location = static_cast<GLuint>(PRT_LOCATION_WEIGHTS + v);
        const auto offset = static_cast<GLuint>(static_cast<std::size_t>(v) * kAttributeBytes);
        glEnableVertexArrayAttrib(vertex_array, location);
        if (words_ > 0)
            glVertexArrayAttribIFormat(vertex_array, location, std::min(4, words_ - 4 * v), GL_UNSIGNED_INT,
                                       offset);
        else
            glVertexArrayAttribFormat(vertex_array, location, 4, GL_FLOAT, GL_FALSE, offset);
        glVertexArrayAttribBinding(vertex_array, location, kWeightBinding);
    }
}

void GlTransfer::use() const {
    bind_storage(PRT_BINDING_CONSTANTS, constants_);
    bind_storage(PRT_BINDING_CLUSTERS, layouts_);
}

} // namespace prt
