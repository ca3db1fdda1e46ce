#pragma once

// The per-frame work of a game: computes the shader constants of all clusters for a lighting.
//
//     ClusterLighting relighter(transfer);                      // once per model
//     std::vector<glm::vec4> constants(relighter.rows());
//     relighter.update(light, constants);                         // when the lighting changes
//     // If the renderer shadows the suns itself, pass sky and suns separately:
//     relighter.update({sky.coefficients, suns.coefficients}, constants);
//
// Several models can share a lighting; each has its own relighter. For a rotated model the lighting must be
// rotated by the inverse: `ShRotation(order, inverse of the model's rotation).apply(light, rotated)`.
// Constants are linear in the lighting: constants of two lightings can be blended instead of computed again.
// Stable.

#include "prt/clustered_transfer.h"
#include "prt/support/glm_layout.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Means and basis directions of all clusters, stored for fast products with a lighting. The conversion of
/// packed integers to weights is folded in, so that a shader multiplies the integers directly. Immutable,
/// thread-safe.
class ClusterLighting {
public:
    /// Copies the required data of `transfer`.
    explicit ClusterLighting(const ClusteredTransfer& transfer);

    int order() const { return layout_.order; }
    const TransferLayout& layout() const { return layout_; }
    /// Total number of constants: per cluster one mean, the predictor rows and m_k basis directions, in the
    /// order of `ClusterLayout::first_row`, times the number of outputs.
    std::size_t rows() const { return rows_; }

    /// Computes the constants for `lighting` and writes (r, g, b, 0) for every row to `constants` [rows].
    /// Allocates nothing. Throws `Error` if `lighting` has too few bands.
    void update(const LightingView& lighting, std::span<glm::vec4> constants) const;
    /// Writes only the rows from `first` up to `last`, to spread the work over threads or frames. `first` is
    /// rounded down and `last` up to a multiple of 16.
    void update(const LightingView& lighting, std::span<glm::vec4> constants, std::size_t first,
                std::size_t last) const;

    /// Matrix for the product on the GPU (shaders/prt_constants.comp): [rows / 16, rounded up]
    /// [dimension][16]; rows past the end are 0.
    std::span<const float> matrix() const { return matrix_; }

private:
    TransferLayout layout_;
    std::size_t rows_;
    std::vector<float> matrix_;
};

/// Blends the constants of two lightings: out = a + share (b - a). `out` may be `a` or `b`.
void blend_constants(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float share,
                     std::span<glm::vec4> out);

} // namespace prt
