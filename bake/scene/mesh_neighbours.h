#pragma once

// Receivers that share an edge of a mesh, and the repair of receivers that are sealed in.

#include "prt/receivers.h"
#include "prt/surfaces.h"

#include <algorithm>
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

/// Replaces the values of marked receivers by the mean of their neighbours that have values, ring by ring.
class Refill {
public:
    Refill() = default;
    /// `sealed` [receivers]. A part of a mesh that is marked as a whole stays as it is.
    Refill(const MeshNeighbours& neighbours, const std::vector<bool>& sealed);

    /// `values` [receivers][stride].
    template <class Value>
    void apply(std::span<Value> values, std::size_t stride) const {
        for (const Step& step : steps_) {
            Value* const to = &values[step.receiver * stride];
            std::fill_n(to, stride, Value(0));
            for (const std::uint32_t source : step.sources)
                for (std::size_t i = 0; i < stride; ++i)
                    to[i] += values[source * stride + i] / static_cast<Value>(step.sources.size());
        }
    }
    std::size_t size() const { return steps_.size(); }

private:
    struct Step {
        std::uint32_t receiver;
        std::vector<std::uint32_t> sources;
    };
    std::vector<Step> steps_; ///< in this order: later ones may use earlier ones
};

} // namespace prt
