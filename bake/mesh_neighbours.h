#pragma once

// Receivers that share an edge of a mesh, and the repair of receivers inside geometry.

#include "prt/receivers.h"
#include "prt/surfaces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Which receivers are joined by an edge of a triangle. Receivers of one position and normal count as one, so
/// that a mesh hangs together where vertices are split for other reasons; the first of them stands for all.
class MeshNeighbours {
public:
    /// The first `fronts` of `receivers` are corners of `surfaces`; the others have no neighbours.
    MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts);
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        const std::uint32_t p = place_[receiver];
        return std::span(neighbours_).subspan(first_[p], first_[p + 1] - first_[p]);
    }

private:
    std::vector<std::uint32_t> place_; ///< [receivers]
    std::vector<std::size_t> first_;   ///< [receivers + 1]
    std::vector<std::uint32_t> neighbours_;
};

/// Share of rays on back faces above which a receiver lies inside geometry.
inline constexpr float kInsideShare = 0.25f;

/// Replaces the values of marked receivers by the mean of their neighbours that have values, ring by ring.
class Refill {
public:
    Refill() = default;
    /// `inside` [receivers]. A part of a mesh that is marked as a whole stays as it is.
    Refill(const MeshNeighbours& neighbours, const std::vector<bool>& inside);

    /// `values` [receivers][stride].
    void apply(std::span<float> values, std::size_t stride) const;
    std::size_t size() const { return steps_.size(); }

private:
    struct Step {
        std::uint32_t receiver;
        std::vector<std::uint32_t> sources;
    };
    std::vector<Step> steps_; ///< in this order: later ones may use earlier ones
};

} // namespace prt
