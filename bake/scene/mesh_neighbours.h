#pragma once

// Neighbours of receivers along the edges of a mesh.

#include "bake/scene/receivers.h"
#include "bake/scene/surfaces.h"
#include "prt/core/adjacency.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Finds receivers that are joined by an edge of a triangle. Receivers of one node, position and normal count
/// as one receiver, so that a mesh is connected where vertices are duplicated for other reasons; the first of
/// them represents all.
class MeshNeighbours {
public:
    /// The first `fronts` of `receivers` are corners of `surfaces`; the others have no neighbours. If `asked`
    /// [receivers] is not empty, finds only the neighbours of the marked receivers and of their duplicates.
    MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts,
                   const std::vector<bool>& asked = {});
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        return adjacency_.of(position_[receiver]);
    }

private:
    std::vector<std::uint32_t> position_; ///< [receivers] first receiver at the same position
    Adjacency adjacency_;                 ///< edges between first receivers
};

} // namespace prt
