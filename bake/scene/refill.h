#pragma once

// Repairs receivers that are sealed in.

#include "bake/scene/mesh_neighbours.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Replaces the values of marked receivers by the mean of their neighbours that have values, ring by ring.
class Refill {
public:
    Refill() = default;
    /// Marks receivers by `sealed` [receivers]. A part of a mesh in which all receivers are marked does not
    /// change.
    Refill(const MeshNeighbours& neighbours, const std::vector<bool>& sealed);

    /// Fills `values` [receivers][stride].
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
    bool empty() const { return steps_.empty(); }
    /// Returns the number of filled receivers below `receivers`.
    std::size_t size(std::size_t receivers) const {
        return static_cast<std::size_t>(
            std::ranges::count_if(steps_, [&](const Step& step) { return step.receiver < receivers; }));
    }

private:
    struct Step {
        std::uint32_t receiver;
        std::vector<std::uint32_t> sources;
    };
    std::vector<Step> steps_; ///< in this order: a step may use values of earlier steps
};

} // namespace prt
