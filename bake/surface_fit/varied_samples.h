#pragma once

// Samples of the surface with densities that depend on light.

#include "bake/surface_fit/surface_samples.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt {

/// Values of receivers that determine the density of samples, [receivers][columns].
struct ChoiceValues {
    std::span<const float> values;
    std::size_t columns = 1;
};

struct VariedSpread {
    std::size_t count = 0; ///< approximate number of samples
    std::uint64_t seed = 0;
    bool backs = true;    ///< include backs that have receivers
    bool by_node = false; ///< half of the samples are shared equally among nodes, independent of their size
};

/// Spreads samples by their possible interpolation error: more where corners of a triangle differ in a
/// column, relative to the column's mean. The areas of samples are unbiased weights of sums over the surface.
SurfaceSamples sample_varied(const Surfaces& surfaces, const TransportReceivers& receivers,
                             const ChoiceValues& light, const VariedSpread& spread);

/// Picks about `count` of `many` samples with probability in proportion to `likely` [many]; the areas become
/// the areas that they represent.
SurfaceSamples pick_samples(const SurfaceSamples& many, std::span<const double> likely, std::size_t count);

} // namespace prt
