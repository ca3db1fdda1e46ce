#pragma once

// Jumps of the error between clusters, which show as seams. Experimental.

#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/transfer_view.h"

#include <cstdint>
#include <memory>
#include <span>

namespace prt {

/// A jump of contrast that nobody sees on a surface of one colour: on a head under a sunset, 8 % show nothing,
/// 11 % the first blotches.
inline constexpr double kUnseenJump = 0.05;

/// Rotations about +Y, by equal angles, under which skies are looked at.
inline constexpr int kRotationsOfJumps = 24;

/// Measures jumps of contrast along the edges whose ends are in different clusters (`VisibleError::seams`,
/// docs/math.md, eq. 33c). Y and Y_a of the reference are computed once, for any number of approximations.
/// Keeps references to `reference` and to what `surface` views.
class ClusterJumps {
public:
    /// Under the mean lighting of `metric`, by root mean squares. Throws `Error` when layouts or numbers of
    /// receivers differ.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface, const LightMetric& metric,
                 int threads = 0);
    /// Under each of `skies` alone, at each of its rotations.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface,
                 std::span<const Lighting> skies, int threads = 0);
    ~ClusterJumps();

    /// The 99th percentile of the jumps by area, the largest of all lights. `clusters` [receivers]. 0 without
    /// edges between clusters. Throws `Error` when layouts or numbers of receivers differ.
    double percentile_99(const TransferView& approximation, std::span<const std::uint16_t> clusters) const;

private:
    struct Lights;

    const TransferView& reference_;
    ReceiverSurface surface_;
    int threads_;
    std::unique_ptr<const Lights> lights_;
};

} // namespace prt
