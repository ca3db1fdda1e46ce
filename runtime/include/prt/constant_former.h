#pragma once

// The per-frame work of a game: the constants of all clusters for a lighting.
//
//     ConstantFormer former(transfer);                       // once per model
//     std::vector<glm::vec4> constants(former.rows());
//     former.form(light, constants);                         // when the lighting changes
//     former.form({sky.coefficients, suns.coefficients}, constants); // or: the renderer shadows suns itself
//
// Several models share a lighting: each has its former. A model that turns wants the lighting turned the
// other way: `ShRotation(order, inverse of the model's rotation).apply(light, turned)`. Constants are linear
// in the lighting: those of two lightings can be blended instead of formed anew. Stable.

#include "prt/clustered_transfer.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Means and directions of all clusters, laid out for fast products with a lighting; what turns packed
/// integers into weights is worked in, so that a shader multiplies the integers themselves. Immutable,
/// thread-safe.
class ConstantFormer {
public:
    /// Copies what it needs of `transfer`.
    explicit ConstantFormer(const ClusteredTransfer& transfer);

    int order() const { return layout_.order; }
    const TransferLayout& layout() const { return layout_; }
    /// Constants in all: per cluster one mean and m_k directions, in the order of `ClusterLayout::first_row`,
    /// of each as many as there are outputs.
    std::size_t rows() const { return rows_; }

    /// Writes (r, g, b, 0) for every row to `constants` [rows]. Allocates nothing. Throws `Error` if
    /// `lighting` has fewer bands.
    void form(const LightingView& lighting, std::span<glm::vec4> constants) const;
    /// Only the rows from `first` up to `last`, to spread the work over threads or frames; `first` is rounded
    /// down and `last` up to a multiple of 16.
    void form(const LightingView& lighting, std::span<glm::vec4> constants, std::size_t first,
              std::size_t last) const;

    /// What a compute shader multiplies instead (shaders/prt_constants.comp): [rows / 16, rounded up]
    /// [dimension][16], rows past the end 0.
    std::span<const float> matrix() const { return matrix_; }

private:
    TransferLayout layout_;
    std::size_t rows_;
    std::vector<float> matrix_;
};

/// a + share (b - a) for all constants; `out` may be either.
void blend_constants(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float share,
                     std::span<glm::vec4> out);

} // namespace prt
