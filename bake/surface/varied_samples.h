#pragma once

#include "surface/surface_samples.h"

#include <cstddef>
#include <span>

namespace prt {

/// Values of receivers that a choice of samples goes by, [receivers][columns].
struct ChoiceValues {
    std::span<const float> values;
    std::size_t columns = 1;
};

/// About `count` of `dense`, those more often over which interpolation may err: where corners of a triangle
/// differ in a column, relative to its mean. `by_node`: half of them go to each node alike, however small.
/// Areas become what the samples stand for.
SurfaceSamples pick_varied(const SurfaceSamples& dense, const Surfaces& surfaces,
                           const TransportReceivers& receivers, const ChoiceValues& light, std::size_t count,
                           bool by_node);

} // namespace prt
