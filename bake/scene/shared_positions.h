#pragma once

// Vertices that are duplicated for reasons other than light.

#include "bake/scene/trace_scene.h"
#include "bake/scene/transport_receivers.h"
#include "prt/core/transfer.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Groups of front receivers of one node, position and normal with nothing between them: they have the same
/// light, and differ only by the noise of their rays. On a wall of separate quads four receivers meet at each
/// corner.
class SharedPositions {
public:
    /// Receivers on surfaces that transmit light or have a medium inside are in no group.
    SharedPositions(const TraceScene& scene, const TransportReceivers& receivers);

    /// Factor that `average` applies to the squared noise of each receiver, [receivers], fronts first.
    std::vector<float> left(std::size_t receivers) const;
    /// First receiver of each receiver's group, or the receiver itself, [receivers].
    std::vector<std::uint32_t> first_of_each(std::size_t receivers) const;
    /// Replaces the transfer of every receiver by the mean of its group. `transfer` has the front receivers.
    void average(Transfer& transfer) const;

private:
    std::vector<std::vector<std::uint32_t>> groups_;
};

} // namespace prt
