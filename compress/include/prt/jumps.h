#pragma once

// Jumps of the error between clusters, which are visible as seams. Experimental.

#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/transfer_view.h"

#include <cstdint>
#include <memory>
#include <span>

namespace prt {

/// Contrast jump that is invisible on a surface of uniform color. On a head under a sunset, nothing is
/// visible at 8 %, and the first blotches appear at 11 %.
inline constexpr double kUnseenJump = 0.05;

/// Number of equally spaced rotations about +Y under which skies are evaluated.
inline constexpr int kRotationsOfJumps = 24;

/// Measures contrast jumps along the edges whose ends are in different clusters (`VisibleError::seams`,
/// docs/math.md, eq. 33c). Y and Y_a of the reference are computed once for any number of approximations.
/// Keeps references to `reference` and to the data of `surface`.
class ClusterJumps {
public:
    /// Measures root mean square jumps over the lightings of `metric`. Throws `Error` if layouts or numbers
    /// of receivers differ.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface, const LightMetric& metric,
                 int threads = 0);
    /// Measures jumps under each of `skies` alone, at each of its kRotationsOfJumps rotations.
    ClusterJumps(const TransferView& reference, const ReceiverSurface& surface,
                 std::span<const Lighting> skies, int threads = 0);
    ~ClusterJumps();

    /// Returns the 99th percentile of the jumps, weighted by area: the maximum over all lights. `clusters` is
    /// [receivers]. Returns 0 without edges between clusters. Throws `Error` if layouts or numbers of
    /// receivers differ.
    double percentile_99(const TransferView& approximation, std::span<const std::uint16_t> clusters) const;

private:
    struct Lights;

    const TransferView& reference_;
    ReceiverSurface surface_;
    int threads_;
    std::unique_ptr<const Lights> lights_;
};

} // namespace prt
