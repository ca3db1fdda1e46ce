#pragma once

// Jumps of the contrast error between clusters, which are visible as seams. Experimental.

#include "prt/compress/light_metric.h"
#include "prt/compress/receiver_surface.h"
#include "prt/core/transfer_view.h"

#include <cstdint>
#include <memory>
#include <span>

namespace prt {

/// Jump of the contrast error (docs/terminology.md) up to which a seam is invisible on a surface of uniform
/// color: 0.05 = 5 %. On a head under a sunset, nothing is visible at 8 %, and the first blotches appear at
/// 11 %.
inline constexpr double kUnseenJump = 0.05;

/// Number of equally spaced rotations about +Y at which `ClusterJumps` evaluates each sky.
inline constexpr int kRotationsOfJumps = 24;

/// Measures jumps of the contrast error along the edges between two clusters, as `VisibleError::seams` does
/// (docs/math.md, eq. 33c), for any number of approximations of one reference. Keeps references to
/// `reference` and to the arrays that `surface` views; both must outlive the object. Edges must refer to
/// existing receivers, which is not checked.
class ClusterJumps {
public:
    /// Prepares to measure jumps whose root mean square is taken over all lightings of `metric`. Uses
    /// `surface.areas` [receivers] and `surface.edges`. `threads` 0: all. Throws `Error` if the layouts of
    /// `metric` and `reference`, or the numbers of areas and receivers, differ.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface, const LightMetric& metric,
                 int threads = 0);
    /// Prepares to measure jumps separately under each of `skies` at each of kRotationsOfJumps rotations.
    /// Requires a layout with one output. Uses `surface.areas` [receivers] and `surface.edges`. `threads` 0:
    /// all. Throws `Error` if a sky or its suns have fewer bands than the layout of `reference` or are not
    /// finite, if the number of lamp strengths is neither 0 nor the number of lamps, or if the numbers of
    /// areas and receivers differ.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface,
                 std::span<const Lighting> skies, int threads = 0);
    ~ClusterJumps();

    /// Returns the 99th percentile of the jumps of `approximation` along the edges between two clusters, each
    /// edge weighted by the area of its two ends. With skies: the maximum of this percentile over skies and
    /// rotations. `clusters` [receivers] is the cluster of each receiver. Returns 0 if no edge connects two
    /// clusters, or if there are no skies. Throws `Error` if `approximation` and the reference differ in
    /// layout or number of receivers, or if `clusters` has another length.
    double percentile_99(const TransferView& approximation, std::span<const std::uint16_t> clusters) const;

private:
    struct Lights;

    const TransferView& reference_;
    ReceiverSurface surface_;
    int threads_;
    std::unique_ptr<const Lights> lights_;
};

} // namespace prt
