#pragma once

#include "surface/surface_samples.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// Values of receivers that a choice of samples goes by, [receivers][columns].
struct ChoiceValues {
    std::span<const float> values;
    std::size_t columns = 1;
};

struct VariedSpread {
    std::size_t count = 0; ///< approximate
    std::uint64_t seed = 0;
    bool backs = true;    ///< also on backs that have receivers
    bool by_node = false; ///< half of them go to each node alike, however small it is
};

/// Samples by the error that interpolation may have: more where corners of a triangle differ in a column,
/// relative to its mean. The areas of samples are unbiased weights of sums over the surface.
SurfaceSamples sample_varied(const Surfaces& surfaces, const TransportReceivers& receivers,
                             const ChoiceValues& light, const VariedSpread& spread);

/// About `count` of `many`, more often where `likely` [many] is large; areas become what each stands for.
SurfaceSamples pick_samples(const SurfaceSamples& many, std::span<const double> likely, std::size_t count);

} // namespace prt
