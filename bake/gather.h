#pragma once

// Interreflection as a sparse linear operator (docs/math.md, section 6).

#include "prt/surfaces.h"
#include "prt/tracer.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Receivers of the transport: those of the scene, then the back sides of those on surfaces that scatter on
/// both sides.
struct TransportReceivers {
    Receivers receivers;
    std::vector<std::uint32_t> back; ///< [scene's receivers]: index of the back side, kNoReceiver where none is
    std::size_t fronts = 0;

    std::uint32_t back_of(std::uint32_t front) const;
};
inline constexpr std::uint32_t kNoReceiver = ~0u;

/// Adds back sides to `fronts` where `surfaces` scatter on both sides.
TransportReceivers transport_receivers(Receivers fronts, const Surfaces& surfaces);

/// The gather F: (F X)_p,c = sum over entries of weight_c X_source,c. Rows are receivers.
class GatherOperator {
public:
    GatherOperator(std::size_t receivers, int channels) : rows_(receivers), channels_(channels) {}

    /// Makes row `receiver` from what `rays` of its rays met. Rows may be made from several threads.
    void set_row(std::uint32_t receiver, std::span<const Hit> hits, int rays, const Surfaces& surfaces,
                 const TransportReceivers& receivers);

    int channels() const { return channels_; }
    std::size_t entries() const;
    std::size_t bytes() const;

    /// to = F from; both [receivers][channels][order²].
    void apply(int order, std::span<const float> from, std::span<float> to, int threads) const;

    struct Row {
        std::uint32_t count = 0;
        std::unique_ptr<std::uint32_t[]> sources; ///< [count]
        std::unique_ptr<float[]> weights;         ///< [count][channels]
    };
    const Row& row(std::size_t receiver) const { return rows_[receiver]; }

private:
    std::vector<Row> rows_;
    int channels_;
};

} // namespace prt
