#pragma once

// Receivers that share an edge of a mesh.

#include "prt/adjacency.h"
#include "prt/receivers.h"
#include "prt/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Which receivers are joined by an edge of a triangle. Receivers of one node, position and normal count as
/// one, so that a mesh hangs together where vertices are split for other reasons; the first of them stands
/// for all.
class MeshNeighbours {
public:
    /// The first `fronts` of `receivers` are corners of `surfaces`; the others have no neighbours. Where
    /// `asked` [receivers] is not empty, neighbours of those are found, and of whoever shares their places.
    MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts,
                   const std::vector<bool>& asked = {});
    std::span<const std::uint32_t> of(std::size_t receiver) const { return adjacency_.of(place_[receiver]); }

private:
    std::vector<std::uint32_t> place_; ///< [receivers]
    Adjacency adjacency_;              ///< of those that stand for a place
};

} // namespace prt
