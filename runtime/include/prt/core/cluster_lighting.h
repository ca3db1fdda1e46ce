#pragma once

// The per-frame work of a game: computes the shader constants (a color per row of a cluster) of all clusters
// for a lighting.
//
//     ClusterLighting relighter(transfer);                      // once per model
//     std::vector<glm::vec4> constants(relighter.rows());
//     relighter.update(light, constants);                         // when the lighting changes
//     // If the renderer shadows the suns itself, pass sky and suns separately:
//     relighter.update({sky.coefficients, suns.coefficients}, constants);
//
// Several models can share a lighting; each model needs its own ClusterLighting. If the renderer rotates a
// model, rotate the lighting by the inverse: `ShRotation(order, inverse of the
// rotation).apply(light.coefficients, rotated)`. Constants are linear in the lighting: `blend_constants`
// blends those of two lightings faster than `update` computes new ones. Stable.

#include "prt/core/clustered_transfer.h"
#include "prt/core/glm_layout.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Computes the constants of one model: the products of the rows of all clusters with a lighting. For packed
/// weights the constants are scaled and shifted so that a shader multiplies the stored integers directly.
/// Immutable, thread-safe.
class ClusterLighting {
public:
    /// Copies the required data of `transfer`. Throws `Error` if its layout is invalid, or if `free_rows`
    /// freed its rows.
    explicit ClusterLighting(const ClusteredTransfer& transfer);

    /// Returns the number of SH bands of the lighting.
    int order() const { return layout_.order; }
    /// Returns the layout of the transfer vectors, reduced to one output (`TransferLayout::of_one_output`).
    const TransferLayout& layout() const { return layout_; }
    /// Returns the number of constants: the number of rows of all clusters (per cluster k one mean, the
    /// predictor rows, m_k basis directions), times the number of outputs (1 for exit radiance;
    /// 4, 9 or 16 SH coefficients at probes). Constants are in the order of
    /// `ClusteredBases::rows`; the outputs of a row are consecutive.
    std::size_t rows() const { return rows_; }

    /// Computes all constants for `lighting` and writes them to `constants` [rows() or more], (r, g, b, 0)
    /// each. Allocates nothing unless it throws. Throws `Error` if the sky or the suns of `lighting` have
    /// fewer than `order()` bands, or if `lighting.lamps` has neither 0 nor layout().lamps() elements.
    void update(const LightingView& lighting, std::span<glm::vec4> constants) const;
    /// Computes only constants `first` .. `last` - 1, to spread the work over threads or frames, and writes
    /// each at its index in `constants` [rows() or more]. Rounds `first` down and `last` up to a multiple of
    /// 16, at most rows(): threads must use ranges that begin and end at multiples of 16. Throws the errors
    /// of the other overload.
    void update(const LightingView& lighting, std::span<glm::vec4> constants, std::size_t first,
                std::size_t last) const;

    /// Returns the matrix by which a GPU computes the constants (shaders/prt_constants.comp):
    /// [blocks][layout().dimension()][16]. Block b contains rows 16 b .. 16 b + 15; the last block is padded
    /// with zeros. The span refers into this object.
    std::span<const float> matrix() const { return matrix_; }

private:
    TransferLayout layout_;
    std::size_t rows_;
    std::vector<float> matrix_; ///< see `matrix()`
};

/// Frees the rows of `transfer` and their coded form, of which `ClusterLighting` and `InstanceRelighter` have
/// copies. Call it after their construction. The transfer can then be drawn and evaluated (`evaluate`), but
/// not decoded, written or given to another relighter: these throw `Error`.
void free_rows(ClusteredTransfer& transfer);

/// Blends the constants `a` and `b` of one model under two lightings: out = a + share (b - a). `share` 0
/// gives `a`; 1 gives `b`, up to rounding; other values are not clamped. All spans must have the same length,
/// which is not checked; `out` may be `a` or `b`.
void blend_constants(std::span<const glm::vec4> a, std::span<const glm::vec4> b, float share,
                     std::span<glm::vec4> out);

} // namespace prt
