#pragma once

// Vertices that are split for other reasons than light.

#include "prt/trace_scene.h"
#include "prt/transfer.h"
#include "transport/transport_receivers.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Groups of front receivers of one node, position and normal between which nothing stands: they have the
/// same light, and differ by the noise of their rays. On a wall of separate quads four meet at each corner.
class SharedPlaces {
public:
    /// Receivers of surfaces that light passes, or with a medium inside, are in no group.
    SharedPlaces(const TraceScene& scene, const TransportReceivers& receivers);

    /// Factor that `average` applies to the squared noise of each receiver, [receivers], fronts first.
    std::vector<float> left(std::size_t receivers) const;
    /// First receiver of the group of each receiver, or the receiver itself, [receivers].
    std::vector<std::uint32_t> first_of_each(std::size_t receivers) const;
    /// Gives every receiver the mean of its group. `transfer` is of the fronts.
    void average(Transfer& transfer) const;

private:
    std::vector<std::vector<std::uint32_t>> groups_;
};

} // namespace prt
